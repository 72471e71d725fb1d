#include "service/work/worker.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/work/encoder.h"
#include "solver/base/file.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

/// A worker with a fake solver.
struct Bench {
    explicit Bench(std::size_t max_resident = 4)
        : worker(jobs, encoder, solver.factory(), {1, max_resident}) {}

    ScratchFolder folder;
    FakeSolver solver;
    JobStore jobs;
    FrameStore frames{folder.path()};
    Encoder encoder{frames,
                    {[this](const std::string& job, const FrameInfo& info) { jobs.note_picture(job, info); },
                     [this](const std::string& job, const std::exception_ptr& failure) {
                         jobs.end(job, JobState::failed, problem_of(failure));
                     }}};
    Worker worker;

    std::string submit(int frame_count, std::uint64_t seed = 1) {
        Job draft;
        draft.frames = {0, frame_count - 1};
        draft.settings.sequence.seed = seed;
        const std::string id = jobs.add(draft).id;
        worker.submit(id);
        return id;
    }
    /// Every event of a job, waited for until it ends.
    std::vector<Event> follow(const std::string& id) {
        const auto log = jobs.events(id);
        std::vector<Event> events;
        while (true) {
            const auto batch =
                log->wait_after(events.empty() ? 0 : events.back().id, std::chrono::milliseconds(60'000));
            if (batch.status == EventLog::Status::ended) return events;
            events.insert(events.end(), batch.events.begin(), batch.events.end());
        }
    }
    JobState wait_for(const std::string& id) {
        follow(id);
        return jobs.find(id)->state;
    }
    void wait_for_steps(std::size_t count) const {
        while (solver.steps().size() < count) std::this_thread::yield();
    }
};

TEST(Worker, AJobRunsToItsEnd) {
    Bench bench;
    const std::string id = bench.submit(3);
    const auto events = bench.follow(id);
    const Job job = *bench.jobs.find(id);
    EXPECT_EQ(job.state, JobState::succeeded);
    EXPECT_EQ(job.frames_done, 3);
    EXPECT_EQ(job.statistics.patches, 99U);
    EXPECT_EQ(job.warnings.size(), 1U);
    EXPECT_TRUE(job.started && job.ended && *job.started <= *job.ended);
    for (const FrameInfo& info : bench.frames.newest(id)) {
        EXPECT_TRUE(info.final);
        EXPECT_EQ(info.error_bound, 0.125);
        EXPECT_EQ(info.picture_error, 0.03);
    }
    EXPECT_EQ(bench.frames.newest(id).size(), 3U);
    EXPECT_EQ(bench.solver.alive(), 0);
}

/// Dies whenever it is to compute the second frame.
class DyingRun : public JobRun {
  public:
    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context&) override {
        if (frame == 1) throw ChildDied(ChildDied::Cause::memory, "it took too much");
        on_revision(fake_revision(frame, FakeSolver::revisions));
        return {};
    }
    EditOutcome apply(const Edit&, const Context&) override { return {}; }
    [[nodiscard]] SequenceStatistics statistics() const override { return {}; }
    [[nodiscard]] Warnings warnings() const override { return {}; }
};

TEST(Worker, AJobWhoseProcessesTakeTooMuchMemoryFailsWithThatName) {
    Bench bench;
    int begun = 0;
    Worker worker(bench.jobs, bench.encoder, [&](const Job&, const Context&, const std::stop_token&) {
        ++begun;
        return std::make_unique<DyingRun>();
    });
    Job draft;
    draft.frames = {0, 3};
    const std::string id = bench.jobs.add(draft).id;
    worker.submit(id);
    EXPECT_EQ(bench.wait_for(id), JobState::failed);
    const Job job = *bench.jobs.find(id);
    ASSERT_TRUE(job.error);
    EXPECT_EQ(job.error->code, "job_out_of_memory");
    EXPECT_EQ(job.error->place, "frame 1");
    EXPECT_EQ(job.frames_done, 1);
    EXPECT_EQ(begun, 3);
    EXPECT_EQ(job.warnings.size(), 2U);
}

TEST(Worker, TheFirstFrameShowsThreeRevisionsBeforeItsFinalOne) {
    Bench bench;
    const auto events = bench.follow(bench.submit(5));
    std::vector<EventKind> first_frame;
    for (const Event& event : events)
        if (event.frame == 0) first_frame.push_back(event.kind);
    EXPECT_THAT(first_frame, testing::ElementsAre(EventKind::image, EventKind::image, EventKind::image,
                                                  EventKind::final_image));
}

TEST(Worker, JobsTakeTurnsFrameByFrame) {
    Bench bench;
    bench.solver.close();
    std::vector<std::string> ids = {bench.submit(6), bench.submit(6), bench.submit(6)};
    bench.solver.open();
    for (const auto& id : ids) EXPECT_EQ(bench.wait_for(id), JobState::succeeded);
    // The first may have begun before the others came; after that the jobs go round.
    std::map<std::string, int> reached;
    for (const auto& [job, frame] : bench.solver.steps()) {
        EXPECT_EQ(frame, reached[job]++);
        int least = 6;
        int most = 0;
        for (const auto& id : ids) {
            least = std::min(least, reached[id]);
            most = std::max(most, reached[id]);
        }
        EXPECT_LE(most - least, 2);
    }
}

TEST(Worker, KeepsNoMoreJobsInMemoryThanAllowed) {
    Bench bench(2);
    bench.solver.close();
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(bench.submit(2));
    bench.solver.open();
    for (const auto& id : ids) EXPECT_EQ(bench.wait_for(id), JobState::succeeded);
    std::set<std::string> begun;
    for (const auto& [job, frame] : bench.solver.steps()) {
        begun.insert(job);
        EXPECT_LE(begun.size(), 2U);
        if (frame == 1) begun.erase(job);
    }
    EXPECT_EQ(bench.solver.alive(), 0);
}

TEST(Worker, AFailureEndsItsJobAlone) {
    Bench bench;
    const std::string good = bench.submit(4);
    const std::string failing = bench.submit(4, FakeSolver::failing_seed);
    testing::internal::CaptureStderr();
    const std::string throwing = bench.submit(4, FakeSolver::throwing_seed);
    EXPECT_EQ(bench.wait_for(failing), JobState::failed);
    EXPECT_EQ(bench.wait_for(throwing), JobState::failed);
    EXPECT_EQ(bench.wait_for(good), JobState::succeeded);
    EXPECT_EQ(bench.wait_for(bench.submit(1)), JobState::succeeded);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("secret of the inside"));
    EXPECT_EQ(bench.jobs.find(failing)->error->code, "cannot_converge");
    EXPECT_EQ(bench.jobs.find(failing)->error->place, "material wall");
    EXPECT_EQ(bench.jobs.find(throwing)->error->status, 500);
    EXPECT_THAT(bench.jobs.find(throwing)->error->detail, testing::Not(testing::HasSubstr("secret")));
}

TEST(Worker, ARunningStepIsCancelledAtOnce) {
    Bench bench;
    const std::string id = bench.submit(2, FakeSolver::hanging_seed);
    bench.wait_for_steps(1);
    EXPECT_TRUE(bench.worker.cancel(id));
    EXPECT_FALSE(bench.worker.cancel(id));
    EXPECT_EQ(bench.jobs.find(id)->state, JobState::cancelled);
    // The compute thread is free again, and the state is gone by the time another job is through.
    EXPECT_EQ(bench.wait_for(bench.submit(1)), JobState::succeeded);
    EXPECT_EQ(bench.solver.alive(), 0);
}

TEST(Worker, JobsThatWaitAreCancelledWithoutBeingRun) {
    Bench bench(1);
    const std::string first = bench.submit(1, FakeSolver::hanging_seed);
    bench.wait_for_steps(1);
    const std::string second = bench.submit(3);
    const std::string third = bench.submit(3);
    EXPECT_TRUE(bench.worker.cancel(second));
    EXPECT_EQ(bench.jobs.find(second)->state, JobState::cancelled);
    bench.worker.cancel(first);
    EXPECT_EQ(bench.wait_for(third), JobState::succeeded);
    for (const auto& [job, frame] : bench.solver.steps()) EXPECT_NE(job, second);
}

TEST(Worker, EndsWithAJobInHand) {
    JobState state = JobState::queued;
    {
        Bench bench;
        const std::string id = bench.submit(1, FakeSolver::hanging_seed);
        bench.submit(3);
        bench.wait_for_steps(1);
        bench.worker.cancel(id);
        state = bench.jobs.find(id)->state;
    }
    EXPECT_EQ(state, JobState::cancelled);
}

TEST(Worker, ADiskThatFailsFailsTheJob) {
    Bench bench;
    bench.solver.close();
    const std::string id = bench.submit(3);
    write_file(bench.folder.path() / id, "a file where the job's folder should be");
    testing::internal::CaptureStderr();
    bench.solver.open();
    EXPECT_EQ(bench.wait_for(id), JobState::failed);
    EXPECT_EQ(bench.wait_for(bench.submit(1)), JobState::succeeded);
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(bench.jobs.find(id)->error->code, "io");
}

}  // namespace
}  // namespace afterglow
