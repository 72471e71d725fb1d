#include "solver/sequence/sequence.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>

#include "solver/base/stopwatch.h"
#include "solver/image/tone_map.h"
#include "solver/sequence/asked_error.h"
#include "solver/sequence/choose.h"
#include "solver/sequence/frame_refinement.h"
#include "solver/sequence/prepare.h"
#include "solver/sequence/quality.h"
#include "solver/sequence/settle_error.h"

namespace afterglow {

namespace {

// Lines of a patch that the automatic exposure is taken from: enough to tell light from dark.
constexpr Index exposure_look = 16;
// Certificate at which a preliminary picture is good enough to be shown.
constexpr double coarse_error = 0.5;
// Side of the picture that the automatic exposure is taken from.
constexpr int exposure_picture_height = 90;

/// Fixed over a job, so that frames do not pump, and taken from time 0 whichever frame comes first, so that
/// parts of an animation computed apart fit together.
float find_exposure(SequenceState::Parts& parts, const Context& context) {
    if (parts.config.exposure_ev) return static_cast<float>(*parts.config.exposure_ev);
    FrameRefinement frame(parts, 0);
    frame.look(exposure_look, *parts.strategy, context);
    frame.solve(coarse_error, context);
    const int height = std::min(parts.config.height, exposure_picture_height);
    const int width = std::max(1, height * parts.config.width / parts.config.height);
    return automatic_exposure_ev(frame.preliminary_picture(width, height, context));
}

/// Hands a frame's pictures to the caller, numbered.
class Publisher {
  public:
    Publisher(const SequenceState::Parts& parts, int frame, const RevisionSink& sink, const Context& context)
        : parts_(parts), frame_(frame), sink_(sink), context_(context) {}

    [[nodiscard]] bool wants_preliminary() const {
        return sink_ && parts_.config.revisions == Revisions::all;
    }

    [[nodiscard]] bool has_published() const { return count_ > 0; }

    void publish_preliminary(Picture radiance, double residual) {
        publish(std::move(radiance), residual, {});
    }
    void publish_final(Picture radiance, const FrameStatistics& statistics) {
        Revision revision;
        revision.final = true;
        revision.picture_error = statistics.picture_error;
        revision.picture_error_spread = statistics.picture_error_spread;
        publish(std::move(radiance), statistics.residual, std::move(revision));
    }

  private:
    void publish(Picture radiance, double residual, Revision revision) {
        if (!sink_) return;
        revision.frame = frame_;
        revision.revision = ++count_;
        revision.residual = residual;
        revision.srgb = to_srgb(radiance, *parts_.exposure_ev, context_);
        revision.radiance = std::move(radiance);
        sink_(revision);
    }

    const SequenceState::Parts& parts_;
    int frame_;
    const RevisionSink& sink_;
    const Context& context_;
    int count_ = 0;
};

/// How many lines of a patch each preliminary picture of a frame is made from: few at first where nothing has
/// been shown yet.
std::vector<Index> preliminary_looks(const SequenceState::Parts& parts) {
    const Index all = parts.sight->lines_per_patch();
    std::vector<Index> looks;
    const bool follows = parts.kept_light || parts.kept_rows;
    if (parts.frames_shown == 0 || (parts.edited && !follows))
        looks = {std::max(all / 16, Index{4}), std::max(all / 4, Index{8})};
    // What follows the last frame is there before a preliminary picture could be.
    if (!follows) looks.push_back(all);
    return looks;
}

/// Says once in a job that the asked error is out of reach, and how near its frames came.
void warn_of_exhaustion(SequenceState::Parts& parts, const FrameRefinement& frame, int frame_number) {
    if (!frame.exhausted() || parts.warned_of_exhaustion) return;
    parts.warned_of_exhaustion = true;
    std::ostringstream bound;
    bound << std::setprecision(2) << frame.certificate().error_bound;
    parts.warnings.push_back({"error", "is finer than single precision can certify: frame " +
                                           std::to_string(frame_number) + " ends within " + bound.str()});
}

/// Says ahead that the picture may be farther off than asked.
void warn_of_fine_error(SequenceState::Parts& parts) {
    if (!error_settles_all(parts.config) || *parts.config.asked_error >= finest_promised_error) return;
    std::ostringstream promised;
    promised << 100 * finest_promised_error << " %";
    parts.warnings.push_back({"error", "is finer than pictures are known to get: below " + promised.str() +
                                           " only the solution's certificate follows it for certain"});
}

/// Changes since the frame before of those lines that the solution has not counted, whose targets it notes.
std::uint64_t count_changes(SequenceState::Parts& parts) {
    const bool counted = parts.kept_light && !parts.kept_light->matrix.ledger.has_moving_lamps;
    const std::size_t first =
        counted ? std::size_t{parts.mesh.static_size()} * parts.sight->lines_per_patch() : 0;
    const std::span now = std::span(parts.visible.patch).subspan(first);
    std::uint64_t changes = 0;
    if (!parts.visible_before.empty())
        for (std::size_t i = 0; i < now.size(); ++i) changes += now[i] != parts.visible_before[i] ? 1U : 0U;
    parts.visible_before.assign(now.begin(), now.end());
    return changes;
}

/// All of a frame's lines, its light as the job solves it, and the picture of that.
Picture finish(SequenceState::Parts& parts, FrameRefinement& frame, Publisher& publisher,
               const Context& context) {
    frame.look(parts.sight->lines_per_patch(), *parts.strategy, context);
    frame.solve_finally(level_of(parts.config).certificate, context);
    // After an edit all of the picture may be new, which takes longer than the light that follows.
    if (parts.edited && publisher.wants_preliminary() && !publisher.has_published())
        publisher.publish_preliminary(
            frame.preliminary_picture(parts.config.width, parts.config.height, context),
            frame.certificate().residual);
    return frame.final_picture(context);
}

/// The same, made again and more finely as long as the asked error is not settled and seems missed.
Picture settled_picture(SequenceState::Parts& parts, std::optional<FrameRefinement>& frame, int frame_number,
                        Publisher& publisher, const Context& context) {
    for (double done = 0;;) {
        // Half of what is left is set apart for a picture that may have to be made again.
        const double end = is_to_be_settled(parts) ? (1 + done) / 2 : 1;
        const Context stage = context.part(done, end);
        done = end;
        Picture picture = finish(parts, *frame, publisher, stage);
        if (!is_to_be_settled(parts)) return picture;
        const ProbeEstimate& estimate = frame->probe(picture, stage);
        if (!settle_error(parts, estimate, stage.part(settled_at, 1))) return picture;
        if (publisher.wants_preliminary())
            publisher.publish_preliminary(std::move(picture), frame->certificate().residual);
        const FrameStatistics earlier = frame->statistics();
        frame.emplace(parts, frame_number);
        frame->add_cost(earlier);
    }
}

}  // namespace

SequenceState::SequenceState(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SequenceState::SequenceState(SequenceState&&) noexcept = default;
SequenceState& SequenceState::operator=(SequenceState&&) noexcept = default;
SequenceState::~SequenceState() = default;
const SequenceStatistics& SequenceState::statistics() const {
    return parts_->statistics;
}
const Warnings& SequenceState::warnings() const {
    return parts_->warnings;
}

const World& SequenceState::world() const {
    return parts_->world;
}

SequenceState make_state(World world, const SequenceConfig& config, const Context& context) {
    const Stopwatch watch;
    check(config);
    auto parts = std::make_unique<SequenceState::Parts>(std::move(world), config);
    MethodChoice choice = choose_method(parts->world, config);
    parts->config.visibility = choice.visibility;
    parts->config.solution = choice.solution;
    parts->statistics.method = method_name(choice.visibility, choice.solution);
    parts->statistics.method_reason = std::move(choice.reason);
    parts->camera = find_camera(parts->world, config.camera);
    parts->strategy = make_strategy(choice.visibility, parts->world, parts->clock());
    warn_of_fine_error(*parts);
    begin_settling(*parts);
    mesh_world(*parts, context);
    parts->statistics.setup = watch.elapsed();
    return SequenceState(std::move(parts));
}

FrameStatistics step(SequenceState& state, int frame_number, const RevisionSink& on_revision,
                     const Context& context) {
    SequenceState::Parts& parts = state.parts();
    if (frame_number < 0) throw Error(ErrorKind::invalid_input, "frame", "must be 0 or more");
    const Stopwatch watch;
    const Milliseconds outside_before = parts.statistics.outside_frames();
    if (!parts.exposure_ev) parts.exposure_ev = find_exposure(parts, context.part(0, 0.1));
    parts.statistics.exposure_ev = parts.exposure_ev;

    const bool settles_before = frame_number != 0 && is_to_be_settled(parts);
    FrameStatistics cost_before;
    if (settles_before) cost_before = settle_error_at_start(parts, context.part(0.1, 0.5));

    std::optional<FrameRefinement> frame(std::in_place, parts, frame_number);
    frame->add_cost(cost_before);
    Publisher publisher(parts, frame_number, on_revision, context);
    if (publisher.wants_preliminary()) {
        const Context part = context.part(settles_before ? 0.5 : 0.1, 0.6);
        for (const Index directions : preliminary_looks(parts)) {
            const double done = static_cast<double>(directions) / parts.sight->lines_per_patch();
            const Context stage = part.part(0.25 * done, done);
            frame->look(directions, *parts.strategy, stage);
            frame->solve(coarse_error, stage);
            publisher.publish_preliminary(
                frame->preliminary_picture(parts.config.width, parts.config.height, stage),
                frame->certificate().residual);
        }
    }
    const Context last = context.part(0.6, 1);
    Picture picture = settled_picture(parts, frame, frame_number, publisher, last);
    warn_of_exhaustion(parts, *frame, frame_number);
    if (parts.config.estimate == Estimate::probes) frame->estimate_error(picture, last);
    publisher.publish_final(std::move(picture), frame->statistics());

    FrameStatistics statistics = frame->statistics();
    statistics.frame = frame_number;
    statistics.visibility_changes += count_changes(parts);
    ++parts.frames_shown;
    parts.edited = false;
    parts.statistics.work_ahead = parts.earlier_work_ahead;
    const auto ahead = parts.strategy->work_ahead();
    parts.statistics.work_ahead.insert(parts.statistics.work_ahead.end(), ahead.begin(), ahead.end());
    statistics.total = watch.elapsed() - (parts.statistics.outside_frames() - outside_before);
    context.report(1, "frame finished");
    return statistics;
}

std::vector<FrameStatistics> render_sequence(World world, const SequenceConfig& config, int first_frame,
                                             int last_frame, const RevisionSink& on_revision,
                                             const Context& context) {
    if (first_frame < 0 || last_frame < first_frame)
        throw Error(ErrorKind::invalid_input, "frames", "must be a range A-B with 0 <= A <= B");
    SequenceConfig with_range = config;
    with_range.frames_expected = last_frame - first_frame + 1;
    SequenceState state = make_state(std::move(world), with_range, context.part(0, 0.05));
    std::vector<FrameStatistics> frames;
    const double count = last_frame - first_frame + 1.0;
    for (int f = first_frame; f <= last_frame; ++f) {
        const double done = 0.05 + 0.95 * (f - first_frame) / count;
        frames.push_back(step(state, f, on_revision, context.part(done, done + 0.95 / count)));
    }
    return frames;
}

int last_frame_of(const World& world, const SequenceConfig& config) {
    const double rate = config.frames_per_second > 0 ? config.frames_per_second : world.frames_per_second;
    // A key written at frame n stands at n/fps rounded to single precision.
    return static_cast<int>(std::floor(world.duration_s * rate + 1e-3));
}

}  // namespace afterglow
