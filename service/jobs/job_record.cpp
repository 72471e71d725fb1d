#include "service/jobs/job_record.h"

#include <array>
#include <cstdint>

#include "service/base/limits.h"
#include "service/jobs/job_json.h"
#include "service/jobs/settings.h"

namespace afterglow {

namespace {

using std::chrono::microseconds;

Json micros_or_null(const std::optional<Timestamp>& time) {
    if (!time) return nullptr;
    return std::chrono::duration_cast<microseconds>(time->time_since_epoch()).count();
}

std::optional<Timestamp> time_of(const Json& micros) {
    if (micros.is_null()) return std::nullopt;
    return Timestamp(
        std::chrono::duration_cast<Timestamp::duration>(microseconds(micros.get<std::int64_t>())));
}

JobState state_named(const std::string& name) {
    for (const JobState state : all_job_states)
        if (name == name_of(state)) return state;
    throw Error(ErrorKind::invalid_input, "job record", "there is no state \"" + name + "\"");
}

/// The settings as they are shown; those that were not given are left out, so that they read as they were.
Json settings_record(const JobSettings& settings) {
    Json record = Json::object();
    const Json shown = to_json(settings);
    for (const auto& [name, value] : shown.items())
        if (!value.is_null()) record[name] = value;
    return record;
}

Problem problem_of_record(const Json& json) {
    return {json.at("status").get<int>(), json.at("code").get<std::string>(),
            json.at("detail").get<std::string>(), json.value("place", "")};
}

}  // namespace

SequenceStatistics sequence_statistics_of(const Json& json) {
    SequenceStatistics statistics;
    statistics.method = json.value("method", "");
    statistics.method_reason = json.value("method_reason", "");
    statistics.patches = json.value("patches", std::uint64_t{0});
    statistics.actor_patches = json.value("actor_patches", std::uint64_t{0});
    statistics.sight_lines = json.value("sight_lines", std::uint64_t{0});
    statistics.rays_per_patch = json.value("rays_per_patch", 0);
    statistics.setup = Milliseconds(json.value("setup_ms", 0.0));
    statistics.static_pass = Milliseconds(json.value("static_ms", 0.0));
    statistics.static_from_cache = json.value("static_from_cache", false);
    if (const auto known = json.find("exposure_ev"); known != json.end() && known->is_number())
        statistics.exposure_ev = known->get<float>();
    if (const auto known = json.find("made_for_error"); known != json.end() && known->is_number())
        statistics.made_for_error = known->get<double>();
    return statistics;
}

Json to_record(const Job& job) {
    const Json shown = to_json(job);
    return {{"id", job.id},
            {"state", name_of(job.state)},
            {"scene", job.scene},
            {"paths", job.paths},
            {"settings", settings_record(job.settings)},
            {"priority", job.priority},
            {"first_frame", job.frames.first},
            {"last_frame", job.frames.last},
            {"frames_per_second", job.frames_per_second},
            {"owner", job.owner},
            {"key", job.idempotency_key},
            {"key_hash", job.idempotency_hash},
            {"created", micros_or_null(job.created)},
            {"started", micros_or_null(job.started)},
            {"ended", micros_or_null(job.ended)},
            {"frames_removed", micros_or_null(job.frames_removed)},
            {"error", shown.at("error")},
            {"warnings", shown.at("warnings")},
            {"statistics", shown.at("statistics")}};
}

Job job_of_record(const Json& record) {
    try {
        Job job;
        job.id = record.at("id").get<std::string>();
        job.state = state_named(record.at("state").get<std::string>());
        if (job.state == JobState::running) job.state = JobState::queued;
        job.scene = record.at("scene").get<std::string>();
        job.paths = record.at("paths").get<std::string>();
        job.settings = read_settings(JsonView(record.at("settings"), "job record"), Limits{});
        job.priority = record.value("priority", 0);
        job.frames = {record.at("first_frame").get<int>(), record.at("last_frame").get<int>()};
        const double asked = job.settings.sequence.frames_per_second;
        job.frames_per_second = record.value("frames_per_second", asked > 0 ? asked : job.frames_per_second);
        job.owner = record.at("owner").get<std::string>();
        job.idempotency_key = record.at("key").get<std::string>();
        job.idempotency_hash = record.at("key_hash").get<std::string>();
        job.created = time_of(record.at("created")).value_or(Timestamp{});
        job.started = time_of(record.at("started"));
        job.ended = time_of(record.at("ended"));
        job.frames_removed = time_of(record.value("frames_removed", Json()));
        if (!record.at("error").is_null()) job.error = problem_of_record(record.at("error"));
        for (const Json& warning : record.at("warnings"))
            job.warnings.push_back(
                {warning.at("place").get<std::string>(), warning.at("message").get<std::string>()});
        job.statistics = sequence_statistics_of(record.at("statistics"));
        return job;
    } catch (const Json::exception& e) {
        throw Error(ErrorKind::invalid_input, "job record", e.what());
    }
}

}  // namespace afterglow
