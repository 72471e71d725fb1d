#pragma once

namespace afterglow {

/// Where two actors lie in one another their faces may share a plane, as the tops of two boxes of one height
/// do that walk through each other. Rounding would decide line by line which of them is seen. So all who look
/// for the nearest hold to one rule: of actors met at distances that differ by less than this share, the one
/// of the lower number is seen; the lines of an actor itself see that actor. A tenth of a millimetre in ten
/// metres; rounding stays below it but where a line all but grazes a face.
inline constexpr float tie_share = 1e-5F;

/// How near an actor of a higher number must come to be seen instead of one that is met at `distance_m`.
constexpr float before_tie(float distance_m) {
    return distance_m * (1 - tie_share);
}

/// How far off an actor of a lower number may be and yet be seen instead of one that is met at `distance_m`.
constexpr float after_tie(float distance_m) {
    return distance_m * (1 + tie_share);
}

}  // namespace afterglow
