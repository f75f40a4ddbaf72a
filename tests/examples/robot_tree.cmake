# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the drawing of a robot on good and bad descriptions and options.
#
# cmake -Dprogram=<robot_tree> -Dfolder=<for files> -P robot_tree.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(0 "robot tree: links=20 joints=19 coordinates=16 centre_of_mass=0.141589,-0.044722,0.499868\n$")
file(STRINGS ${folder}/out/links.csv links)
list(LENGTH links count)
if(NOT count EQUAL 21 OR NOT links MATCHES "link,x,y,z,qw,qx,qy,qz;floor,0,0,0,1,0,0,0;")
  message(FATAL_ERROR "links.csv holds\n${links}")
endif()
file(STRINGS ${folder}/out/coordinates.csv coordinates)
list(LENGTH coordinates count)
if(NOT count EQUAL 17 OR NOT coordinates MATCHES ";drive.y,-0.05,-inf,inf,0,1,0;")
  message(FATAL_ERROR "coordinates.csv holds\n${coordinates}")
endif()
run(0 "robot description" --help)

set(joint "<parent link=\"a\"/><child link=\"b, 1\"/><origin xyz=\"0 0 2\"/>")
file(WRITE ${folder}/slides.urdf "<robot><link name=\"a\"/><link name=\"b, 1\"><inertial><mass value=\"3\"/></inertial></link>
<joint name=\"j\" type=\"prismatic\">${joint}<axis xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"1\"/></joint></robot>")
run(0 "links=2 joints=1 coordinates=1 centre_of_mass=0.000000,0.000000,2.500000\n$" --urdf slides.urdf)
file(READ ${folder}/out/links.csv links)
if(NOT links MATCHES "\nb__1,0,0,2.5,1,0,0,0\n$")
  message(FATAL_ERROR "links.csv holds\n${links}")
endif()
run(0 "centre_of_mass=0.000000,0.000000,1.000000\n$" --urdf slides.urdf --joints -1)
file(WRITE ${folder}/fixed.urdf
  "<robot><link name=\"a\"/><link name=\"b, 1\"/><joint name=\"j\" type=\"fixed\">${joint}</joint></robot>")
run(0 "links=2 joints=1 coordinates=0\n$" --urdf fixed.urdf)

run(1 "nothing.urdf: cannot be read" --urdf nothing.urdf)
run(1 "--joints: 1 numbers expected, got 2" --urdf slides.urdf --joints 1,2)
run(1 "--joints: 'nan' is not a finite number" --joints nan)
file(WRITE ${folder}/two.urdf "<robot><link name=\"a\"/>\n<link name=\"b\"/></robot>")
run(1 "two.urdf:2: <link name=\"b\">: it is a second root, the first is .a." --urdf two.urdf)
