#include "solver/scene/placement.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "solver/scene/place.h"
#include "solver/scene/simplify.h"

namespace afterglow {

namespace {

/// Transforms composed for all paths of a scene together: a hundred actors three levels deep for twenty
/// minutes, and still only seconds of work.
constexpr double max_composed = 10e6;
/// How far the lengths and angles of a rigid shape may seem to change through rounding.
constexpr float rigid_tolerance = 1e-4F;

Mat3 matrix_of(const Quat& rotation) {
    return glm::mat3_cast(rotation);
}

/// The rotation of a camera or light whose axes went through an uneven scale: it still looks along its −z,
/// with its y as near to up as can be.
Quat view_rotation(const Placement& placement) {
    const float z_length = glm::length(placement.linear[2]);
    const Vec3 z = placement.linear[2] / z_length;
    const Vec3 y = placement.linear[1] - glm::dot(placement.linear[1], z) * z;
    const float y_length = glm::length(y);
    if (!(z_length > 0) || !(y_length > 0)) return glm::normalize(placement.rotation);
    return glm::normalize(glm::quat_cast(Mat3(glm::cross(y / y_length, z), y / y_length, z)));
}

/// The rotation that takes the baked shape to what `linear` makes of it, if there is one.
Quat rigid_rotation(const Mat3& linear, const Mat3& baked, const std::string& place) {
    const Mat3 turn = linear * glm::inverse(baked);
    const Mat3 gram = glm::transpose(turn) * turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(gram[column][row] - (column == row ? 1.0F : 0.0F)) < rigid_tolerance))
                throw Error(ErrorKind::unsupported, place,
                            "turns below an uneven scale and so changes its shape; apply the scale of its "
                            "parents before exporting");
    return glm::normalize(glm::quat_cast(turn));
}

}  // namespace

Transform NodeMotion::at(double time_s, JumpSide side) const {
    Transform out = local;
    if (!translation.empty()) out.translation = value_in<Vec3>(translation, time_s, side);
    if (!rotation.empty()) out.rotation = value_in<Quat>(rotation, time_s, side);
    return out;
}

std::vector<NodeMotion> motions_of(const Scene& scene, double tolerance_m, double tolerance_rad) {
    std::vector<NodeMotion> motions;
    motions.reserve(scene.nodes.size());
    for (const auto& node : scene.nodes) motions.push_back({node.local, {}, {}});
    for (const auto& track : scene.tracks.node_translation) {
        auto keys = simplified(track.keys, tolerance_m);
        auto& motion = motions.at(track.target);
        motion.local.translation = keys.front().value;
        if (keys.size() > 1) motion.translation = std::move(keys);
    }
    for (const auto& track : scene.tracks.node_rotation) {
        auto keys = simplified(track.keys, tolerance_rad);
        auto& motion = motions.at(track.target);
        motion.local.rotation = keys.front().value;
        if (keys.size() > 1) motion.rotation = std::move(keys);
    }
    return motions;
}

std::vector<Index> chain_to(const Scene& scene, Index node) {
    std::vector<Index> chain;
    for (Index n = node; n != no_index; n = scene.nodes[n].parent) chain.push_back(n);
    std::reverse(chain.begin(), chain.end());
    return chain;
}

Placement Placement::then(const Transform& local) const {
    const Mat3 turn = matrix_of(local.rotation);
    const Mat3 scaled(turn[0] * local.scale.x, turn[1] * local.scale.y, turn[2] * local.scale.z);
    return {linear * scaled, rotation * local.rotation, point(local.translation)};
}

Placement PathMaker::at(const std::vector<Index>& chain, const Moment& moment) const {
    Placement placement;
    for (const Index node : chain) placement = placement.then(motions_[node].at(moment.time_s, moment.side));
    return placement;
}

PathMaker::Scales PathMaker::scales_above(const std::vector<Index>& chain) const {
    const auto is_even = [&](Index node) {
        const Vec3& s = motions_[node].local.scale;
        return s.x > 0 && s.x == s.y && s.y == s.z;
    };
    return std::all_of(chain.begin(), chain.end() - 1, is_even) ? Scales::even : Scales::uneven;
}

std::vector<Moment> PathMaker::moments(const std::vector<Index>& chain, Scales scales) {
    std::vector<Moment> moments;
    bool bends = false;
    for (const Index node : chain) {
        add_moments(moments, motions_[node].translation);
        add_moments(moments, motions_[node].rotation);
        // A rotation carries everything below it along arcs, which straight runs between keys would cut.
        bends |= !motions_[node].rotation.empty() && (node != chain.back() || scales == Scales::uneven);
    }
    if (moments.empty()) moments.push_back({0, JumpSide::after});
    sort_moments(moments);

    const double frames = (moments.back().time_s - moments.front().time_s) * scene_.frames_per_second;
    const double count = static_cast<double>(moments.size()) + (bends ? frames : 0.0);
    composed_ += count * static_cast<double>(chain.size());
    if (!(composed_ < max_composed))
        throw Error(ErrorKind::too_large, scene_.name, "its nested animations need too many path keys");
    if (bends) add_frames(moments, scene_.frames_per_second);
    return moments;
}

PathMaker::ActorFrame PathMaker::actor_frame(Index node) {
    const auto chain = chain_to(scene_, node);
    const Scales scales = scales_above(chain);
    const auto when = moments(chain, scales);
    const Placement first = at(chain, when.front());
    ActorFrame out{glm::inverse(matrix_of(first.rotation)) * first.linear, {}};
    // A shape flattened to nothing has no triangles left, so it does not matter how it turns.
    const bool rigid_by_nature = scales == Scales::even || glm::determinant(out.baked) == 0.0F;
    std::vector<Key<Pose>> keys;
    for (const Moment& moment : when) {
        const Placement placement = at(chain, moment);
        const Quat rotation = rigid_by_nature
                                  ? glm::normalize(placement.rotation)
                                  : rigid_rotation(placement.linear, out.baked,
                                                   place_of("node", scene_.nodes[node].name, node));
        keys.push_back({moment.time_s, {placement.origin, rotation}});
    }
    out.path.keys = simplified(keys, tolerance_m_, tolerance_rad_);
    return out;
}

Path PathMaker::view_path(Index node) {
    const auto chain = chain_to(scene_, node);
    const Scales scales = scales_above(chain);
    std::vector<Key<Pose>> keys;
    for (const Moment& moment : moments(chain, scales)) {
        const Placement placement = at(chain, moment);
        const Quat rotation =
            scales == Scales::even ? glm::normalize(placement.rotation) : view_rotation(placement);
        keys.push_back({moment.time_s, {placement.origin, rotation}});
    }
    return {simplified(keys, tolerance_m_, tolerance_rad_)};
}

}  // namespace afterglow
