#pragma once

#include <string>
#include <utility>
#include <vector>

namespace afterglow {

/// A zip archive of these files in this order; names that end with a slash become folders. With a password
/// the files are encrypted (AES-256).
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files,
                   const std::string& password = {});

}  // namespace afterglow
