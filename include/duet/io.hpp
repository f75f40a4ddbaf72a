// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/io/loop_file.hpp>
#include <duet/io/mesh_file.hpp>
#include <duet/io/recording.hpp>
#include <duet/io/save_plan.hpp>
#include <duet/io/srdf.hpp>
#include <duet/io/table_file.hpp>
#include <duet/io/urdf.hpp>

/// \file
/// All of duet::io: tables, recordings and plans, robot descriptions, meshes, loop-closure
/// constraints as files.
