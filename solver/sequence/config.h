#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace afterglow {

/// How each frame learns which patch every sight line sees.
enum class Visibility {
    automatic,       ///< by what moves and how many frames there are, see choose_method
    retrace,         ///< static and moving geometry traced anew: the yardstick
    back_buffer,     ///< Baum et al. 1986: only the actors are traced, up to the static background
    temporal_graph,  ///< Tost and Pueyo 1993: actors in order of depth, kept from frame to frame
    events,  ///< when each line comes to see something else is found ahead; a frame touches only those
};

/// How each frame's light is solved.
enum class Solution {
    automatic,       ///< likewise
    progressive,     ///< Cohen et al. 1988: shooting, cold every frame
    incremental,     ///< Chen 1990: the last frame's light, and plus or minus what changes bring
    active_passive,  ///< Tost and Pueyo 1993: likewise, hidden patches of little consequence waiting
    residual,        ///< the last frame's light, corrected where it no longer balances
    in_view,         ///< the last frame's light, led on as far as what the camera sees next needs it
};

/// How fine the patches, lines and samples are, in three steps; see QualityLevel.
enum class Quality {
    draft,    ///< even patches, 128 lines each; 1 to 4 camera samples a pixel
    preview,  ///< patches refined where they must be, 256 lines; 4 to 16 samples
    final,    ///< four times the patches, 512 lines; 8 to 64 samples
};

/// Which pictures of a frame are made and handed over. The final one is the same either way.
enum class Revisions {
    all,         ///< coarse ones first, for somebody who watches
    final_only,  ///< none but the final one: less work
};

/// What is said of a final picture's error, beside the certificate of its solution.
enum class Estimate {
    none,    ///< nothing: no further work
    probes,  ///< path tracing of a few pixels, see solver/image/probes.h
};

/// Settings of a job. What a frame finally is depends on these only, never on the clock or the number of
/// threads.
struct SequenceConfig {
    Visibility visibility = Visibility::automatic;  ///< see Visibility
    Solution solution = Solution::automatic;        ///< see Solution
    int frames_expected =
        0;  ///< frames that will be asked for, 0 if that is not known: what pays depends on it
    std::optional<int> rays_per_patch;  ///< sight lines of a patch, 16 to 65,536, rounded up to a multiple of
                                        ///< 16; by quality where not given
    std::optional<double> patch_size_m;  ///< target patch edge, even everywhere; by quality and the scene's
                                         ///< size, and finer where needed, where not given
    /// Relative root mean square error of the picture, in (0, 1): settles what the quality would, see
    /// level_for_error. Where rays_per_patch or patch_size_m are given, it is the solution's certificate and
    /// nothing else. By quality where not given.
    std::optional<double> asked_error;
    /// What an earlier part of the same job came to make its pictures for, see
    /// SequenceStatistics::made_for_error; found from the picture of time 0 where not given.
    std::optional<double> made_for_error;
    Quality quality = Quality::preview;  ///< see Quality
    int width = 640;                     ///< pixels, 1 to 16,384
    int height = 360;                    ///< pixels, 1 to 16,384
    std::string camera;                  ///< by name; empty: the first
    double frames_per_second = 0;        ///< frame n shows time n / fps; 0: the scene's own
    std::optional<double>
        exposure_ev;  ///< stops added to the automatic exposure's neutral 0; automatic where not given
    /// By how much a patch's light may change, relative to the mean, before kept pictures follow; 0 or more.
    /// Where not given, a tenth of the picture's error, and 0 with a solution that is cold every frame. 0:
    /// the picture follows every change.
    std::optional<double> picture_tolerance;
    /// Frames of the camera's path that an in-view solution prepares at once, 1 to 4096; where something
    /// besides the camera moves it prepares each frame by itself.
    int frames_looked_ahead = 24;
    std::uint64_t seed = 1;                ///< of every random choice
    Revisions revisions = Revisions::all;  ///< see Revisions
    Estimate estimate = Estimate::none;    ///< see Estimate
    std::filesystem::path cache_folder;    ///< static rows are kept here; empty: not kept
};

/// A named method as in the literature: a visibility and a solution.
struct Method {
    std::string_view name;
    Visibility visibility;
    Solution solution;
    std::string_view description;
};

/// All named methods. Lookups by name: errors are not_found and list the names there are.
std::span<const Method> methods();
const Method& method_named(std::string_view name);
/// The named method of a pair, or "VISIBILITY+SOLUTION" where no method pairs them.
std::string method_name(Visibility visibility, Solution solution);
Visibility visibility_named(std::string_view name);
Solution solution_named(std::string_view name);
Quality quality_named(std::string_view name);
Estimate estimate_named(std::string_view name);
std::string_view name_of(Visibility visibility);
std::string_view name_of(Solution solution);
std::string_view name_of(Estimate estimate);

}  // namespace afterglow
