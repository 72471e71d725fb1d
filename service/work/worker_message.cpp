#include "service/work/worker_message.h"

#include <cstring>
#include <type_traits>
#include <utility>

#include "service/jobs/edit_json.h"
#include "service/jobs/job_json.h"
#include "service/jobs/job_record.h"

namespace afterglow {

namespace {

/// What a reply has of plain values.
struct Outcomes {
    FrameStatistics frame;
    EditOutcome edit;
};

/// A value as its bytes: both ends are the same program.
template <class Plain>
std::string bytes_of(const Plain& value) {
    static_assert(std::is_trivially_copyable_v<Plain>);
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

template <class Plain>
Plain plain_of(const std::string& bytes) {
    static_assert(std::is_trivially_copyable_v<Plain>);
    if (bytes.size() != sizeof(Plain)) throw ChannelClosed();
    Plain value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::optional<double> optional_of(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

/// Runs `read`; values that are missing or of another type are as bad as no message.
template <class Read>
auto trusted(const Read& read) {
    try {
        return read();
    } catch (const Json::exception&) {
        throw ChannelClosed();
    }
}

}  // namespace

Message message_of(const StartMessage& start) {
    Json edits = Json::array();
    for (const JobEdit& request : start.job.edits) edits.push_back(sources_of(request.edits));
    return {MessageKind::start,
            {{"job", to_record(start.job)},
             {"edits", std::move(edits)},
             {"source", to_json(start.source)},
             {"cache_folder", start.cache_folder.string()},
             {"threads", start.threads}}};
}

StartMessage start_of(const Message& message) {
    return trusted([&] {
        const Json& values = message.values;
        Job job = job_of_record(values.at("job"));
        for (const Json& sources : values.at("edits"))
            job.edits.push_back({edits_of_sources(sources), 0, std::nullopt});
        return StartMessage{std::move(job), world_source_of(values.at("source")),
                            values.at("cache_folder").get<std::string>(), values.at("threads").get<int>()};
    });
}

Message step_message(int frame) {
    return {MessageKind::step, frame};
}

int frame_of_step(const Message& message) {
    return trusted([&] { return message.values.get<int>(); });
}

Message edit_message(const Edit& edit) {
    return {MessageKind::edit, sources_of({edit})};
}

Edit edit_of(const Message& message) {
    return trusted([&] { return edits_of_sources(message.values).at(0); });
}

Message message_of(const Progress& progress) {
    return {MessageKind::progress, progress.fraction, std::string(progress.doing)};
}

Progress progress_of(const Message& message) {
    return trusted([&] { return Progress{message.values.get<double>(), message.bytes, {}}; });
}

Message message_of(const Revision& revision) {
    const Picture& picture = revision.radiance;
    Message message{MessageKind::revision,
                    {{"frame", revision.frame},
                     {"revision", revision.revision},
                     {"final", revision.final},
                     {"residual", revision.residual},
                     {"width", picture.width},
                     {"height", picture.height},
                     {"picture_error", or_null(revision.picture_error)},
                     {"picture_error_spread", or_null(revision.picture_error_spread)}}};
    const std::size_t radiance_bytes = picture.pixels.size() * sizeof(Rgb);
    message.bytes.resize(radiance_bytes + revision.srgb.size());
    std::memcpy(message.bytes.data(), picture.pixels.data(), radiance_bytes);
    std::memcpy(message.bytes.data() + radiance_bytes, revision.srgb.data(), revision.srgb.size());
    return message;
}

Revision revision_of(const Message& message) {
    return trusted([&] {
        const Json& values = message.values;
        const int width = values.at("width").get<int>();
        const int height = values.at("height").get<int>();
        if (width < 1 || height < 1 || is_too_large(width, height)) throw ChannelClosed();
        const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        const std::size_t radiance_bytes = pixels * sizeof(Rgb);
        if (message.bytes.size() != radiance_bytes + 3 * pixels) throw ChannelClosed();
        Revision revision{values.at("frame").get<int>(),
                          values.at("revision").get<int>(),
                          values.at("final").get<bool>(),
                          values.at("residual").get<double>(),
                          Picture(width, height),
                          std::vector<std::uint8_t>(3 * pixels),
                          optional_of(values.at("picture_error")),
                          optional_of(values.at("picture_error_spread"))};
        std::memcpy(revision.radiance.pixels.data(), message.bytes.data(), radiance_bytes);
        std::memcpy(revision.srgb.data(), message.bytes.data() + radiance_bytes, 3 * pixels);
        return revision;
    });
}

Message message_of(const DoneMessage& done) {
    Message message{MessageKind::done,
                    {{"sequence", to_json(done.sequence)}, {"warnings", to_json(done.warnings)}},
                    bytes_of(Outcomes{done.frame, done.edit})};
    return message;
}

DoneMessage done_of(const Message& message) {
    return trusted([&] {
        const auto outcomes = plain_of<Outcomes>(message.bytes);
        DoneMessage done{
            outcomes.frame, outcomes.edit, sequence_statistics_of(message.values.at("sequence")), {}};
        for (const Json& warning : message.values.at("warnings"))
            done.warnings.push_back(
                {warning.at("place").get<std::string>(), warning.at("message").get<std::string>()});
        return done;
    });
}

}  // namespace afterglow
