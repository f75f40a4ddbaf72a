// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A target of this folder, DUET_FUZZ_TARGET, for clang's libFuzzer, which begins with its seeds.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace DUET_FUZZ_TARGET {
std::vector<std::string> seeds();
void target(const std::string& input);
} // namespace DUET_FUZZ_TARGET

extern "C" {

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  DUET_FUZZ_TARGET::target(std::string(data, data + size));
  return 0;
}

// Occasionally replaces the input by a seed.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned number) {
  static const std::vector<std::string> seeds = DUET_FUZZ_TARGET::seeds();
  if (size <= 1 || number % 1024 == 0) {
    const std::string& seed = seeds[number / 1024 % seeds.size()];
    size = std::min(seed.size(), max_size);
    std::copy_n(seed.begin(), size, data);
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

} // extern "C"
