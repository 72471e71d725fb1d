#include "service/store/job_table.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "service/http/http_message.h"
#include "service/jobs/edit_json.h"
#include "service/jobs/job_record.h"
#include "service/store/frame_journal.h"

namespace afterglow {

namespace {

constexpr const char* state_of = "json_extract(body, '$.state')";
constexpr const char* ended_states = "('succeeded', 'failed', 'cancelled')";
// As Job::is_stale, of a row of `frames`.
constexpr const char* is_stale =
    "EXISTS (SELECT 1 FROM edits WHERE edits.job = frames.job AND edits.revision > frames.job_revision AND "
    "edits.first_frame <= frames.frame)";

}  // namespace

JobTable::JobTable(Database& database) : database_(database) {
    database_.change("DELETE FROM frames WHERE job NOT IN (SELECT id FROM jobs)");
}

/// The jobs that a condition holds for, with their counts. `condition` is all that comes after FROM jobs.
std::vector<JobTable::Entry> JobTable::select(const std::string& condition, const Row& values, Edits edits) {
    std::vector<Entry> entries;
    std::map<std::string, std::size_t> places;
    for (const Row& row :
         database_.ask("SELECT number, body, strikes, strike_frame FROM jobs " + condition, values)) {
        Job job = job_of_record(parse_json(as_text(row[1]), "job record"));
        job.strikes = static_cast<int>(as_integer(row[2]));
        job.strike_frame = static_cast<int>(as_integer(row[3]));
        places.emplace(job.id, entries.size());
        entries.push_back({as_integer(row[0]), std::move(job)});
    }
    const std::string those = " WHERE job IN (SELECT id FROM jobs " + condition + ") ";
    for (const Row& row : database_.ask("SELECT job, first_frame, reused" +
                                            std::string(edits == Edits::whole ? ", body" : "") +
                                            " FROM edits" + those + "ORDER BY job, revision",
                                        values)) {
        JobEdit edit{{}, static_cast<int>(as_integer(row[1])), as_real(row[2])};
        if (edits == Edits::whole) edit.edits = edits_of_sources(parse_json(as_text(row[3]), "edit record"));
        if (const auto place = places.find(as_text(row[0])); place != places.end())
            entries[place->second].job.edits.push_back(std::move(edit));
    }
    for (const Row& row : database_.ask(
             "SELECT job, count(*), sum(" + std::string(is_stale) + ") FROM frames" + those + "GROUP BY job",
             values)) {
        const auto place = places.find(as_text(row[0]));
        if (place == places.end()) continue;
        Job& job = entries[place->second].job;
        job.stale_frames = static_cast<int>(as_integer(row[2]));
        job.frames_done = static_cast<int>(as_integer(row[1])) - job.stale_frames;
    }
    for (Entry& entry : entries)
        entry.job.progress = entry.job.state == JobState::succeeded
                                 ? 1
                                 : static_cast<double>(entry.job.frames_done) / entry.job.frame_count();
    return entries;
}

std::optional<JobTable::Entry> JobTable::find(const std::string& id) {
    auto found = select("WHERE id = ?1", {id}, Edits::whole);
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

std::optional<std::string> JobTable::with_key(const std::string& owner, const std::string& key) {
    const auto rows = database_.ask(
        "SELECT id FROM jobs WHERE json_extract(body, '$.owner') = ?1 AND json_extract(body, '$.key') = ?2",
        {owner, key});
    return rows.empty() ? std::nullopt : std::optional(as_text(rows[0][0]));
}

std::vector<JobTable::Entry> JobTable::unended() {
    return select("WHERE " + std::string(state_of) + " NOT IN " + ended_states + " ORDER BY number", {},
                  Edits::whole);
}

std::vector<JobTable::Entry> JobTable::page(std::int64_t before, const std::optional<JobState>& state,
                                            std::size_t limit) {
    const auto most = static_cast<std::int64_t>(
        std::min(limit, static_cast<std::size_t>(std::numeric_limits<std::int64_t>::max())));
    Row values = {before, most};
    std::string condition = "WHERE number < ?1";
    if (state) {
        condition += " AND " + std::string(state_of) + " = ?3";
        values.emplace_back(std::string(name_of(*state)));
    }
    return select(condition + " ORDER BY number DESC LIMIT ?2", values, Edits::places_only);
}

std::vector<std::string> JobTable::with_frames_at_rest() {
    std::vector<std::string> ids;
    for (const Row& row :
         database_.ask("SELECT id FROM jobs WHERE " + std::string(state_of) + " IN " + ended_states +
                       " AND json_extract(body, '$.frames_removed') IS NULL ORDER BY number"))
        ids.push_back(as_text(row[0]));
    return ids;
}

std::set<std::string> JobTable::uploads_used() {
    std::set<std::string> ids;
    for (const Row& row : database_.ask("SELECT json_extract(body, '$.scene') FROM jobs UNION "
                                        "SELECT json_extract(body, '$.paths') FROM jobs"))
        ids.insert(as_text(row[0]));
    return ids;
}

std::map<JobState, std::int64_t> JobTable::count_by_state() {
    std::map<JobState, std::int64_t> counts;
    for (const Row& row :
         database_.ask("SELECT " + std::string(state_of) + ", count(*) FROM jobs GROUP BY 1"))
        for (const JobState state : all_job_states)
            if (as_text(row[0]) == name_of(state)) counts[state] = as_integer(row[1]);
    return counts;
}

std::int64_t JobTable::count_frames() {
    return as_integer(
        database_.ask("SELECT count(*) FROM frames WHERE NOT " + std::string(is_stale)).at(0).at(0));
}

std::int64_t JobTable::add(const Job& job) {
    const auto rows = database_.ask("INSERT INTO jobs (id, body) VALUES (?1, ?2) RETURNING number",
                                    {job.id, dump(to_record(job))});
    return as_integer(rows.at(0).at(0));
}

std::vector<FrameInfo> JobTable::frames_of(const std::string& id) {
    return durable_frames(database_, id);
}

std::optional<std::string> JobTable::events_of(const std::string& id) {
    const auto rows = database_.ask("SELECT body FROM event_logs WHERE job = ?1", {id});
    return rows.empty() ? std::nullopt : std::optional(as_text(rows[0][0]));
}

void JobTable::put_to_rest(const Job& job, const std::string& events) {
    database_.together([&] {
        update(job);
        database_.change("INSERT OR REPLACE INTO event_logs VALUES (?1, ?2)", {job.id, events});
    });
}

void JobTable::drop_events(const std::string& id) {
    database_.change("DELETE FROM event_logs WHERE job = ?1", {id});
}

void JobTable::update(const Job& job) {
    database_.change("UPDATE jobs SET body = ?2 WHERE id = ?1", {job.id, dump(to_record(job))});
}

void JobTable::forget_frames(const Job& job) {
    database_.together([&] {
        database_.change("DELETE FROM frames WHERE job = ?1", {job.id});
        update(job);
    });
}

void JobTable::add_edit(const Job& job) {
    const JobEdit& edit = job.edits.back();
    database_.together([&] {
        database_.change("INSERT INTO edits VALUES (?1, ?2, ?3, ?4, ?5)",
                         {job.id, std::int64_t{job.revision()}, std::int64_t{edit.first_frame},
                          dump(sources_of(edit.edits)), cell_of(edit.reused)});
        update(job);
    });
}

void JobTable::update_reused(const Job& job, int revision) {
    database_.change("UPDATE edits SET reused = ?3 WHERE job = ?1 AND revision = ?2",
                     {job.id, std::int64_t{revision},
                      cell_of(job.edits.at(static_cast<std::size_t>(revision) - 1).reused)});
}

void JobTable::set_strikes(const std::string& id, int strikes, int frame) {
    database_.change("UPDATE jobs SET strikes = ?2, strike_frame = ?3 WHERE id = ?1",
                     {id, std::int64_t{strikes}, std::int64_t{frame}});
}

void JobTable::remove(const std::string& id) {
    database_.together([&] {
        database_.change("DELETE FROM frames WHERE job = ?1", {id});
        database_.change("DELETE FROM edits WHERE job = ?1", {id});
        database_.change("DELETE FROM event_logs WHERE job = ?1", {id});
        database_.change("DELETE FROM jobs WHERE id = ?1", {id});
    });
}

}  // namespace afterglow
