// Jobs that have ended leave the memory, and nobody can tell.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/jobs/edit_json.h"
#include "service/jobs/job_json.h"
#include "service/store/frame_journal.h"
#include "service/store/job_store.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

/// A store in a folder of its own.
struct Kept {
    explicit Kept(std::size_t ended_in_memory) {
        JobStoreConfig config;
        config.ended_in_memory = ended_in_memory;
        config.at_rest = [this](const std::string& id) { rested.push_back(id); };
        jobs = std::make_unique<JobStore>(config, &table);
    }
    std::string add(const std::string& key, int frames = 3) {
        Job draft;
        draft.scene = "scene";
        draft.frames = {0, frames - 1};
        draft.owner = "me";
        draft.idempotency_key = key;
        draft.idempotency_hash = key;
        draft.warnings = {{"lamp", "is dim"}};
        return jobs->add(draft).id;
    }
    void finish_frame(const std::string& id, int frame) {
        const int revision = jobs->find(id)->revision();
        for (int k = 1; k < 5; ++k)
            jobs->note_picture(id,
                               {frame, revision_of_picture(revision, k), false, 0.5, {}, {}, 0, revision});
        const FrameInfo info{frame, revision_of_picture(revision, 5), true, 0.1, 0.2, {}, 1, revision};
        journal.add({id, info, {}});
        journal.flush();
        jobs->note_picture(id, info);
    }
    std::string ended_job(const std::string& key, int frames = 3) {
        const std::string id = add(key, frames);
        jobs->start(id);
        for (int frame = 0; frame < frames; ++frame) finish_frame(id, frame);
        jobs->end(id, JobState::succeeded);
        return id;
    }
    std::vector<Event> events_after(const std::string& id, std::uint64_t reached) const {
        return jobs->events(id)->wait_after(reached, std::chrono::milliseconds(0)).events;
    }

    ScratchFolder folder;
    Database database{folder.path() / "service.db"};
    JobTable table{database};
    FrameJournal journal{database, [](const FrameJournal::Entry&, const std::exception_ptr&) {},
                         std::chrono::milliseconds(0)};
    std::vector<std::string> rested;
    std::unique_ptr<JobStore> jobs;
};

JobEdit dim_from(int frame) {
    const Json edits = {{"edits", {{{"light", {{"material", "lamp"}, {"emission", {1, 1, 1}}}}}}}};
    return {read_edits(JsonView(edits, "request")), frame, std::nullopt};
}

TEST(JobStoreRest, MemoryDoesNotGrowWithJobsThatHaveEnded) {
    Kept kept(4);
    for (int k = 0; k < 20; ++k) kept.ended_job("");
    const JobStore::Held early = kept.jobs->held();
    EXPECT_EQ(early.jobs, 4U);
    for (int k = 0; k < 100; ++k) kept.ended_job("");
    EXPECT_EQ(kept.jobs->held().jobs, 4U);
    EXPECT_EQ(kept.jobs->held().events, early.events);
    EXPECT_EQ(kept.rested.size(), 116U);
    EXPECT_EQ(kept.jobs->list()->size(), 120U);
}

TEST(JobStoreRest, AnEndedJobIsThereWithItsEventsUnderTheirIds) {
    Kept kept(1);
    const std::string id = kept.ended_job("");
    const auto before = kept.events_after(id, 0);
    const Json job = to_json(*kept.jobs->find(id));
    for (int k = 0; k < 3; ++k) kept.ended_job("");
    ASSERT_THAT(kept.rested, testing::Contains(id));
    EXPECT_EQ(to_json(*kept.jobs->find(id)), job);

    // What is superseded has gone, as it may at any time.
    std::vector<Event> lasting;
    for (const Event& event : before)
        if (event.kind != EventKind::image) lasting.push_back(event);
    for (const std::uint64_t reached : {std::uint64_t{0}, lasting[3].id, lasting.back().id}) {
        const auto after = kept.events_after(id, reached);
        std::size_t k = lasting.size() - after.size();
        for (const Event& event : after) {
            EXPECT_EQ(event.id, lasting[k].id);
            EXPECT_EQ(event.kind, lasting[k].kind);
            EXPECT_EQ(event.data, lasting[k].data);
            EXPECT_GT(event.id, reached);
            ++k;
        }
        EXPECT_EQ(after.empty(), reached == lasting.back().id);
    }
    EXPECT_EQ(kept.jobs->events(id)->end()->id, before.back().id);
}

TEST(JobStoreRest, AJobAtRestGoesOnWhereItWas) {
    Kept kept(1);
    const std::string id = kept.ended_job("");
    const std::uint64_t last = kept.jobs->events(id)->last_id();
    for (int k = 0; k < 3; ++k) kept.ended_job("");
    EXPECT_FALSE(kept.jobs->requeue(id)) << "it succeeded";
    EXPECT_EQ(kept.jobs->edit(id, 0, dim_from(1)), JobStore::EditResult::accepted);
    EXPECT_EQ(kept.jobs->find(id)->frames_done, 1);
    EXPECT_EQ(kept.jobs->find(id)->stale_frames, 2);
    EXPECT_EQ(kept.jobs->first_unfinished(id), 1);
    const auto events = kept.events_after(id, last);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].kind, EventKind::edit);
    EXPECT_FALSE(kept.jobs->stop_token(id).stop_requested());
    EXPECT_TRUE(kept.jobs->start(id));
}

/// A store that keeps one ended job in memory and one that keeps all, told the same: they say the same.
TEST(JobStoreRest, NobodyCanTellWhichJobsAreInMemory) {
    Kept few(1);
    Kept all(1000);
    std::vector<std::string> in_few;
    std::vector<std::string> in_all;
    std::mt19937 random(7);
    const auto same = [&](const auto& ask) { EXPECT_EQ(ask(few, in_few), ask(all, in_all)); };
    for (int turn = 0; turn < 150; ++turn) {
        const std::string key = std::to_string(turn / 3 * 3);
        if (in_few.empty() || random() % 4 == 0) {
            in_few.push_back(few.add(key));
            in_all.push_back(all.add(key));
        }
        const std::size_t at = random() % in_few.size();
        const auto what = random() % 8;
        same([&](Kept& kept, std::vector<std::string>& ids) {
            JobStore& jobs = *kept.jobs;
            const std::string& id = ids[at];
            const auto job = jobs.find(id);
            if (!job) return std::string("gone");
            if (what == 0) return std::to_string(jobs.start(id));
            if (what == 1 && job->state == JobState::running)
                kept.finish_frame(id, jobs.first_unfinished(id) % 3);
            if (what == 2) return std::to_string(jobs.end(id, JobState::failed, Problem{500, "x", "y", "z"}));
            if (what == 3) return std::to_string(jobs.end(id, JobState::succeeded));
            if (what == 4) return std::to_string(jobs.requeue(id));
            if (what == 5)
                return std::to_string(
                    static_cast<int>(jobs.edit(id, job->revision(), dim_from(static_cast<int>(at % 3)))));
            if (what == 6 && turn % 5 == 0) return std::to_string(jobs.remove(id));
            if (what == 7 && turn % 5 == 0) return std::to_string(jobs.forget_frames(id, Timestamp{}, [] {}));
            return std::string();
        });
        same([&](Kept& kept, std::vector<std::string>& ids) {
            const auto shown = [&](const Job& job) {
                Json json = to_json(job);
                for (const char* differs : {"id", "created", "started", "ended", "progress"})
                    json.erase(differs);
                return json.dump();
            };
            std::string told;
            const auto tell = [&](const std::vector<Job>& jobs) {
                for (const Job& job : jobs) told += shown(job);
            };
            for (const JobState state : all_job_states) tell(kept.jobs->list({"", state, 5}).value());
            tell(kept.jobs->list().value());
            for (const Job& job : kept.jobs->unended()) told += shown(job);
            const auto job = kept.jobs->find(ids[at]);
            told += job ? shown(*job) : "none";
            if (job)
                for (const Event& event : kept.events_after(ids[at], 0))
                    if (event.kind != EventKind::image) told += std::to_string(event.id) + " ";
            const auto page = kept.jobs->list({ids[at], std::nullopt, 3});
            told += page ? std::to_string(page->size()) : "no page";
            const JobStore::Counts counts = kept.jobs->counts();
            for (const auto& [state, count] : counts.jobs) told += std::to_string(count) + ",";
            told +=
                std::to_string(counts.frames) + "+" + std::to_string(kept.jobs->ended_with_frames().size());
            return told;
        });
    }
    EXPECT_GT(in_few.size(), 20U);
    EXPECT_GT(few.rested.size(), 10U);
    EXPECT_TRUE(all.rested.empty());
}

TEST(JobStoreRest, WhatOutlivedTheProcessIsReadWhenItIsAskedFor) {
    Kept kept(2);
    std::vector<std::string> ids;
    for (int k = 0; k < 5; ++k) ids.push_back(kept.ended_job(std::to_string(k)));
    const std::string waiting = kept.add("waits");
    JobStore later({{}, std::chrono::milliseconds(0), 1'000'000'000}, &kept.table);
    EXPECT_EQ(later.held().jobs, 1U);
    EXPECT_EQ(later.unended().at(0).id, waiting);
    // Those at rest have kept their ids; the others tell everything anew.
    EXPECT_EQ(later.events(ids.front())->last_id(), kept.jobs->events(ids.front())->last_id());
    EXPECT_GT(later.events(ids.back())->last_id(), 1'000'000'000U);
    Job again;
    again.owner = "me";
    again.idempotency_key = again.idempotency_hash = "1";
    EXPECT_EQ(later.repeated(again)->id, ids[1]);
    again.idempotency_hash = "other";
    EXPECT_THROW(static_cast<void>(later.repeated(again)), ProblemError);
}

}  // namespace
}  // namespace afterglow
