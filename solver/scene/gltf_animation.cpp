#include "solver/scene/gltf_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "solver/scene/gltf_accessors.h"
#include "solver/scene/gltf_nodes.h"

namespace afterglow::gltf {

namespace {

/// Eleven days: past it a time is a mistake, and single precision no longer tells frames apart.
constexpr double max_time_s = 1e6;

enum class Property { translation, rotation, scale };
enum class Interpolation { linear, step, cubic_spline };

/// One channel as the file has it: a value of `components` numbers for every time, for cubic splines an
/// in-tangent, a value and an out-tangent.
struct Channel {
    JsonView place;
    Index node;  ///< of the scene
    Property property;
    Interpolation interpolation;
    std::vector<double> times;
    std::vector<float> numbers;

    [[nodiscard]] std::size_t components() const { return property == Property::rotation ? 4 : 3; }
    /// Number `c` of part `part` (0 in-tangent, 1 value, 2 out-tangent) of key `key`.
    [[nodiscard]] double number(std::size_t key, std::size_t part, std::size_t c) const {
        const std::size_t element = interpolation == Interpolation::cubic_spline ? 3 * key + part : key;
        return double{numbers[element * components() + c]};
    }
};

/// A value before it becomes a vector or a rotation; the fourth number is unused for vectors.
using Numbers = std::array<double, 4>;

Interpolation interpolation_of(const JsonView& sampler) {
    const auto field = sampler.find("interpolation");
    const std::string text = field ? field->as_string() : "LINEAR";
    if (text == "LINEAR") return Interpolation::linear;
    if (text == "STEP") return Interpolation::step;
    if (text == "CUBICSPLINE") return Interpolation::cubic_spline;
    field->fail("unknown interpolation " + in_quotes(text));
}

std::vector<double> read_times(const Document& document, const JsonView& input) {
    const std::vector<float> numbers = read_floats(document, input, 1);
    if (numbers.empty()) input.fail("an animation without keys");
    std::vector<double> times(numbers.begin(), numbers.end());
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (times[i] < 0 || times[i] > max_time_s) input.fail("key times must lie between 0 and 1e6 seconds");
        if (i > 0 && times[i] < times[i - 1]) input.fail("key times must not decrease");
    }
    return times;
}

Vec3 to_vector(const Numbers& n, const JsonView& place) {
    return {to_float(place, n[0]), to_float(place, n[1]), to_float(place, n[2])};
}

Numbers value_of_key(const Channel& channel, std::size_t key) {
    Numbers out{};
    for (std::size_t c = 0; c < channel.components(); ++c) out[c] = channel.number(key, 1, c);
    return out;
}

/// Cubic Hermite spline between key `k` and the next, at `share` of the way.
/// Source: glTF 2.0 specification, appendix C.5.
Numbers spline(const Channel& channel, std::size_t k, double share) {
    const double span = channel.times[k + 1] - channel.times[k];
    const double s2 = share * share;
    const double s3 = s2 * share;
    Numbers out{};
    for (std::size_t c = 0; c < channel.components(); ++c)
        out[c] = (2 * s3 - 3 * s2 + 1) * channel.number(k, 1, c) +
                 span * (s3 - 2 * s2 + share) * channel.number(k, 2, c) +
                 (3 * s2 - 2 * s3) * channel.number(k + 1, 1, c) +
                 span * (s3 - s2) * channel.number(k + 1, 0, c);
    if (channel.property == Property::rotation) {
        const double length =
            std::sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3]);
        // A spline through opposite rotations can pass near zero, where it has no direction.
        if (!(length > 1e-6)) return value_of_key(channel, k);
        for (double& number : out) number /= length;
    }
    return out;
}

/// Calls `add(time, numbers)` for every key that the channel has once it is made piecewise linear.
template <class Add>
void for_linear_keys(const Channel& channel, double frames_per_second, const Add& add) {
    const auto& times = channel.times;
    add(times[0], value_of_key(channel, 0));
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
        if (channel.interpolation == Interpolation::step) add(times[k + 1], value_of_key(channel, k));
        if (channel.interpolation == Interpolation::cubic_spline) {
            constexpr double margin = 1e-3;  // of a frame: no sample right beside a key
            const double first = std::floor(times[k] * frames_per_second + margin) + 1;
            const double end = times[k + 1] * frames_per_second - margin;
            for (double frame = first; frame < end; ++frame) {
                const double time = frame / frames_per_second;
                add(time, spline(channel, k, (time - times[k]) / (times[k + 1] - times[k])));
            }
        }
        add(times[k + 1], value_of_key(channel, k + 1));
    }
}

class AnimationReader {
  public:
    AnimationReader(const Document& document, const std::vector<Index>& places, Scene& scene)
        : document_(document), places_(places), scene_(scene) {}

    void read(const JsonView& animation) {
        const auto samplers = animation.at("samplers").elements();
        for (const JsonView& channel : animation.at("channels").elements()) {
            const JsonView sampler = samplers[channel.at("sampler").as_index(samplers.size())];
            read_channel(channel, sampler);
        }
    }

    void finish() {
        choose_frame_rate();
        for (const Channel& channel : channels_) {
            if (channel.property == Property::scale) {
                fix_scale(channel);
                continue;
            }
            count_samples(channel);
            if (channel.property == Property::translation)
                add_track(channel, translations_,
                          [&](const Numbers& n) { return to_vector(n, channel.place); });
            else
                add_track(channel, rotations_, [&](const Numbers& n) {
                    return to_rotation(n[0], n[1], n[2], n[3], channel.place);
                });
        }
        for (auto& [node, track] : translations_) scene_.tracks.node_translation.push_back(std::move(track));
        for (auto& [node, track] : rotations_) scene_.tracks.node_rotation.push_back(std::move(track));
    }

  private:
    void read_channel(const JsonView& channel, const JsonView& sampler) {
        const JsonView target = channel.at("target");
        const auto reference = target.find("node");
        if (!reference) return warn(channel, "the channel animates no node and is skipped");
        const Index node = places_[reference->as_index(places_.size())];
        if (node == no_index)
            return warn(channel, "the channel animates a node outside the scene and is skipped");
        const JsonView path = target.at("path");
        const std::string text = path.as_string();
        if (text == "weights") return warn(channel, "morph weights are left out; the base shape is shown");
        if (text != "translation" && text != "rotation" && text != "scale")
            path.fail("unknown path " + in_quotes(text));
        const Property property = text == "translation" ? Property::translation
                                  : text == "rotation"  ? Property::rotation
                                                        : Property::scale;
        Channel out{channel, node, property, interpolation_of(sampler), {}, {}};
        const JsonView input = sampler.at("input");
        const JsonView output = sampler.at("output");
        const std::size_t keys = element_count(document_, input);
        const std::size_t values = out.interpolation == Interpolation::cubic_spline ? 3 * keys : keys;
        if (element_count(document_, output) != values)
            output.fail("there must be " + std::to_string(values) + " values for " + std::to_string(keys) +
                        " keys");
        count_keys(channel, static_cast<double>(keys));
        out.times = read_times(document_, input);
        out.numbers = read_floats(document_, output, out.components());
        channels_.push_back(std::move(out));
    }

    void count_keys(const JsonView& place, double more) {
        keys_ += more;
        if (keys_ > static_cast<double>(max_keys))
            throw Error(ErrorKind::too_large, place.place(),
                        "the animations have more than 16 Mi keys in all");
    }

    void count_samples(const Channel& channel) {
        if (channel.interpolation != Interpolation::cubic_spline) return;
        count_keys(channel.place, (channel.times.back() - channel.times.front()) * scene_.frames_per_second);
        warn(channel.place, "cubic splines are sampled " +
                                std::to_string(std::lround(scene_.frames_per_second)) + " times a second");
    }

    void choose_frame_rate() {
        std::vector<double> times;
        for (const Channel& channel : channels_)
            times.insert(times.end(), channel.times.begin(), channel.times.end());
        const FrameRate rate = frame_rate_of(times);
        scene_.frames_per_second = rate.frames_per_second;
        if (!rate.keys_on_frames) return;
        for (Channel& channel : channels_)
            for (double& time : channel.times)
                time = std::round(time * rate.frames_per_second) / rate.frames_per_second;
    }

    void fix_scale(const Channel& channel) {
        const Numbers first = value_of_key(channel, 0);
        double change = 0;
        for (std::size_t k = 1; k < channel.times.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c)
                change = std::max(change, std::abs(channel.number(k, 1, c) - first[c]));
        // Blender writes constant scale tracks beside every motion; those lose nothing.
        if (change > 1e-5)
            warn(channel.place, "the size of " + in_quotes(scene_.nodes[channel.node].name) +
                                    " is animated; its first value is kept");
        scene_.nodes[channel.node].local.scale = to_vector(first, channel.place);
    }

    template <class Value, class Convert>
    void add_track(const Channel& channel, std::map<Index, Track<Value>>& tracks, const Convert& convert) {
        Track<Value> track;
        track.target = channel.node;
        for_linear_keys(channel, scene_.frames_per_second, [&](double time, const Numbers& numbers) {
            track.keys.push_back({time, convert(numbers)});
        });
        scene_.duration_s = std::max(scene_.duration_s, track.keys.back().time_s);
        if (!tracks.insert_or_assign(channel.node, std::move(track)).second)
            scene_.warnings.push_back(
                {channel.place.place(),
                 "a second motion of " + in_quotes(scene_.nodes[channel.node].name) + " replaces the first"});
    }

    /// One warning of a kind is enough: rigs have thousands of channels.
    void warn(const JsonView& place, const std::string& message) {
        if (said_.insert(message).second) scene_.warnings.push_back({place.place(), message});
    }

    const Document& document_;
    const std::vector<Index>& places_;
    Scene& scene_;
    std::vector<Channel> channels_;
    double keys_ = 0;  ///< in all channels so far, samples of splines included
    std::set<std::string> said_;
    std::map<Index, Track<Vec3>> translations_;
    std::map<Index, Track<Quat>> rotations_;
};

}  // namespace

FrameRate frame_rate_of(const std::vector<double>& times_s) {
    for (const double rate : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0}) {
        const auto on_frame = [rate](double time) {
            const double frame = time * rate;
            return std::abs(frame - std::round(frame)) <= 1e-3 + 1e-6 * frame;
        };
        if (std::all_of(times_s.begin(), times_s.end(), on_frame)) return {rate, true};
    }
    return {};
}

void read_animations(const Document& document, const std::vector<Index>& places, Scene& scene) {
    AnimationReader reader(document, places, scene);
    for (const JsonView& animation : document.animations) reader.read(animation);
    reader.finish();
}

}  // namespace afterglow::gltf
