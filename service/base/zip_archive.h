#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace afterglow {

struct ZipLimits {
    std::size_t files = 1000;                     ///< entries, folders included
    std::size_t bytes = std::size_t{256} << 20U;  ///< of all files together, unpacked
};

/// The files of a zip archive as names and contents, folders left out. Whatever an archive says of itself,
/// nothing is unpacked before all of it is known to be within the limits, and no file gets longer than
/// announced. `place` stands for the archive in errors: invalid_input where it is damaged, unsupported for
/// encrypted files and unknown methods, too_large. The only user of libzip. Thread-safety: pure.
std::vector<std::pair<std::string, std::string>> read_zip(std::string_view bytes, const ZipLimits& limits,
                                                          const std::string& place);

}  // namespace afterglow
