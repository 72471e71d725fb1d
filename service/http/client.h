#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace afterglow {

/// What a client may do: see; also submit and change its own jobs; also change everybody's.
enum class Role { viewer, submitter, admin };

/// How much a client may have at a time. Past it a request is 429 where waiting helps, 413 where it does not.
struct Quota {
    static constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();
    std::int64_t jobs = unlimited;       ///< that have not ended
    std::int64_t bytes = unlimited;      ///< uploaded since the service started
    std::int64_t triangles = unlimited;  ///< of a scene
    std::int64_t frames = unlimited;     ///< of a job
    std::int64_t pixels = unlimited;     ///< of a picture
    std::int64_t streams = unlimited;    ///< open
};

/// Their names in token files and problems.
inline constexpr std::array<std::pair<const char*, std::int64_t Quota::*>, 6> quota_fields{
    {{"jobs", &Quota::jobs},
     {"bytes", &Quota::bytes},
     {"triangles", &Quota::triangles},
     {"frames", &Quota::frames},
     {"pixels", &Quota::pixels},
     {"streams", &Quota::streams}}};

/// Who a request comes from. Without tokens everybody is the one local client, who may do everything.
struct Client {
    std::string name = "local";
    Role role = Role::admin;
    Quota quota;
};

}  // namespace afterglow
