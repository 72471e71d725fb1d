#pragma once

// Texts of options and settings into typed values. Each function takes the place to name in its error (an
// option such as "--rays", or a field), and fails with Error{invalid_input}. Thread-safety: all pure.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "solver/base/math.h"

namespace afterglow {

struct PictureSize {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    bool operator==(const PictureSize&) const = default;
};

/// A whole decimal number, low ≤ value ≤ high.
std::int64_t whole_number(const std::string& place, std::string_view text, std::int64_t low,
                          std::int64_t high);
/// A finite decimal number, low ≤ value ≤ high.
double decimal_number(const std::string& place, std::string_view text, double low, double high);
/// A number above 0.
double positive_number(const std::string& place, std::string_view text);
/// A share of one, strictly between 0 and 1: "0.02" or "2%".
double share(const std::string& place, std::string_view text);
/// "WxH", 1 to 16,384 pixels a side and at most 64 Mi pixels in all (what the picture files hold).
PictureSize picture_size(const std::string& place, std::string_view text);
/// "R,G,B", each 0 or more.
Rgb linear_colour(const std::string& place, std::string_view text);
/// Metres in a unit of length: m, cm, mm, in, ft, or a number of metres.
double unit_in_metres(const std::string& place, std::string_view text);

/// A length of time with its unit: s, m, h or d; above 0.
std::chrono::seconds length_of_time(const std::string& place, std::string_view text);

/// A number of bytes with its unit: kB, MB, GB or TB; above 0.
std::uint64_t byte_count(const std::string& place, std::string_view text);

}  // namespace afterglow
