#include "solver/scene/check_tracks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "solver/scene/place.h"

namespace afterglow {

namespace {

void check_value(const Vec3& value, const std::string& place) {
    if (!is_finite(value)) throw Error(ErrorKind::invalid_input, place, "is not finite");
}

void check_value(const Quat& value, const std::string& place) {
    // A looser bound than rounding needs: files carry quaternions as bytes, too.
    if (!(std::abs(glm::length(value) - 1.0F) < 1e-3F))
        throw Error(ErrorKind::invalid_input, place, "is not a rotation (a quaternion of length 1)");
}

void check_value(float value, const std::string& place) {
    if (!std::isfinite(value) || value < 0)
        throw Error(ErrorKind::invalid_input, place, "must be a finite number from 0");
}

/// `elements`: what the targets index, for their names and their number.
template <class T, class Element>
void check(const std::vector<Track<T>>& tracks, const std::vector<Element>& elements, const char* kind,
           const std::string& property) {
    std::vector<bool> seen(elements.size());
    for (const auto& track : tracks) {
        if (track.target >= elements.size())
            throw Error(ErrorKind::invalid_input, "track of " + property,
                        "its target " + std::to_string(track.target) + " does not exist");
        const std::string place = place_of(kind, elements[track.target].name, track.target) + ", " + property;
        if (seen[track.target]) throw Error(ErrorKind::invalid_input, place, "has more than one track");
        seen[track.target] = true;
        if (track.keys.empty()) throw Error(ErrorKind::invalid_input, place, "its track has no keys");
        for (std::size_t k = 0; k < track.keys.size(); ++k) {
            const auto key_place = [&] { return place + " key " + std::to_string(k); };
            const double time = track.keys[k].time_s;
            if (!std::isfinite(time) || time < 0)
                throw Error(ErrorKind::invalid_input, key_place(), "its time must be a finite number from 0");
            if (k > 0 && time < track.keys[k - 1].time_s)
                throw Error(ErrorKind::invalid_input, key_place(), "is earlier than the key before it");
            check_value(track.keys[k].value, key_place());
        }
    }
}

template <class T>
double last_of(const std::vector<Track<T>>& tracks) {
    double last = 0;
    for (const auto& track : tracks)
        if (!track.keys.empty()) last = std::max(last, track.keys.back().time_s);
    return last;
}

}  // namespace

double last_key_time(const Tracks& tracks) {
    return std::max({last_of(tracks.node_translation), last_of(tracks.node_rotation),
                     last_of(tracks.material_emission), last_of(tracks.material_reflectance)});
}

void check_tracks(const Scene& scene) {
    const Tracks& tracks = scene.tracks;
    check(tracks.node_translation, scene.nodes, "node", "translation");
    check(tracks.node_rotation, scene.nodes, "node", "rotation");
    check(tracks.material_emission, scene.materials, "material", "emission scale");
    check(tracks.material_reflectance, scene.materials, "material", "reflectance");
    for (const auto& track : tracks.material_reflectance)
        for (const auto& key : track.keys)
            if (std::min({key.value.r, key.value.g, key.value.b}) < 0)
                throw Error(
                    ErrorKind::invalid_input,
                    place_of("material", scene.materials[track.target].name, track.target) + ", reflectance",
                    "a key is negative");
    if (!(scene.frames_per_second > 0) || scene.frames_per_second > 1000)
        throw Error(ErrorKind::invalid_input, "frame rate", "must be above 0 and at most 1000 a second");
    const double duration = std::max(scene.duration_s, last_key_time(tracks));
    if (!std::isfinite(duration) || scene.duration_s < 0)
        throw Error(ErrorKind::invalid_input, "duration", "must be a finite number from 0");
    if (duration * scene.frames_per_second > max_frames)
        throw Error(ErrorKind::too_large, "duration", "the animation has more than a million frames");
}

}  // namespace afterglow
