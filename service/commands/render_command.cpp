#include "service/commands/render_command.h"

#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "service/base/console.h"
#include "service/commands/frame_writer.h"
#include "service/commands/report.h"
#include "solver/base/file.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Fails where the folder of the frames cannot be what it must be, before any work.
void require_possible_folder(const fs::path& folder) {
    std::error_code error;
    fs::path existing = fs::absolute(folder, error);
    while (!fs::exists(existing, error) && existing.has_relative_path()) existing = existing.parent_path();
    if (!fs::is_directory(existing, error))
        throw Error(ErrorKind::invalid_input, "--out", existing.string() + " is not a folder");
}

World load_world(const RenderOptions& options) {
    try {
        Scene scene = load_scene(options.scene, options.load);
        if (options.paths)
            apply_paths(scene, read_file(*options.paths), options.paths->string(), options.load);
        return assemble(scene, options.load.collinear_tolerance_m, options.load.collinear_tolerance_rad);
    } catch (const Error& e) {
        // A file that cannot be read is bad input, unlike one that cannot be written.
        if (e.kind() == ErrorKind::io) throw Error(ErrorKind::invalid_input, e.place(), e.message());
        throw;
    }
}

std::string finished_line(const FrameStatistics& frame, const FrameRange& range) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "frame %d (%d of %d): %.2f s, solver error at most %.2g %%",
                  frame.frame, frame.frame - range.first + 1, range.last - range.first + 1,
                  frame.total.count() / 1000, 100 * frame.error_bound);
    std::string line = text.data();
    if (frame.picture_error) {
        std::snprintf(text.data(), text.size(), ", picture error about %.2g %%", 100 * *frame.picture_error);
        line += text.data();
    }
    return line;
}

struct Rendered {
    FrameStatistics statistics;
    Revision picture;
};

/// One frame. The static pass runs within the first one but is not counted as its time.
Rendered render_frame(SequenceState& state, int frame, const Context& context) {
    const auto begin = Clock::now();
    const Milliseconds outside_before = state.statistics().outside_frames();
    Rendered out;
    const auto keep_final = [&](const Revision& revision) {
        if (revision.final) out.picture = revision;
    };
    out.statistics = step(state, frame, keep_final, context);
    out.statistics.total = Clock::now() - begin - (state.statistics().outside_frames() - outside_before);
    return out;
}

/// Renders frames one after the other, each written while the next is worked on, and notes what they cost.
class FrameLoop {
  public:
    FrameLoop(const RenderOptions& options, const FrameRange& range, Console& console, Report& report)
        : range_(range), console_(console), report_(report), writer_(options.out) {}

    void render(SequenceState& state, int frame, const Context& context) {
        std::optional<Rendered> rendered;
        try {
            rendered = render_frame(state, frame, context);
        } catch (...) {
            // The frame before is there all the same, or there is more to say than why this one is not.
            finish();
            throw;
        }
        for (; warnings_shown_ < state.warnings().size(); ++warnings_shown_)
            console_.warning(state.warnings()[warnings_shown_]);
        finish();
        report_.frames.push_back(rendered->statistics);
        writer_.begin(std::move(rendered->picture));
    }

    /// Waits for the files of the last frame, which counts as its time, and says so.
    void finish() {
        if (report_.frames.empty()) return;
        const auto begin = Clock::now();
        writer_.finish();
        report_.frames.back().total += Clock::now() - begin;
        console_.line(finished_line(report_.frames.back(), range_));
    }

  private:
    FrameRange range_;
    Console& console_;
    Report& report_;
    FrameWriter writer_;
    std::size_t warnings_shown_ = 0;
};

}  // namespace

void render_command(const RenderOptions& options, const std::stop_token& stop, Clock::time_point started) {
    const bool quiet = options.progress == RenderOptions::Progress::hidden;
    Console console(quiet ? Console::Shows::warnings_only : Console::Shows::progress);
    require_possible_folder(options.out);
    if (options.report) require_writable_file(*options.report);

    World world = load_world(options);
    for (const Warning& warning : world.warnings) console.warning(warning);
    const FrameRange range = options.frames.value_or(FrameRange{0, last_frame_of(world, options.sequence)});
    Report report;
    report.scene = options.scene.string();
    const auto loaded = Clock::now();
    report.load = loaded - started;

    std::string subject = "preparing";
    const Context context(options.threads, stop, [&](const Progress& p) { console.progress(subject, p); });
    const double steps = range.last - range.first + 2;  // preparing counts as a frame
    SequenceConfig config = options.sequence;
    config.frames_expected = range.last - range.first + 1;
    SequenceState state = make_state(std::move(world), config, context.part(0, 1 / steps));
    report.static_pass = Clock::now() - loaded;
    if (const SequenceStatistics& chosen = state.statistics(); !chosen.method_reason.empty())
        console.line("method " + chosen.method + ": " + chosen.method_reason);
    FrameLoop frames(options, range, console, report);
    for (int frame = range.first; frame <= range.last; ++frame) {
        subject = "frame " + std::to_string(frame);
        const double done = frame - range.first + 1;
        frames.render(state, frame, context.part(done / steps, (done + 1) / steps));
    }
    frames.finish();

    report.static_pass += state.statistics().static_pass;
    report.sequence = state.statistics();
    if (options.report) write_file(*options.report, to_json(report, peak_memory_mb()).dump(2) + "\n");
    console.line("frames are in " + options.out.string());
}

}  // namespace afterglow
