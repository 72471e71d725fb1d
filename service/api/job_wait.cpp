#include "service/api/job_wait.h"

#include <algorithm>
#include <utility>

#include "service/jobs/job_json.h"

namespace afterglow {

JobWait::JobWait(const JobStore& jobs, Job job, std::shared_ptr<const EventLog> log,
                 std::chrono::seconds longest)
    : jobs_(jobs),
      job_(std::move(job)),
      log_(std::move(log)),
      reached_(log_->last_id()),
      give_up_(std::chrono::steady_clock::now() + longest) {}

Piece JobWait::next() {
    using std::chrono::milliseconds;
    bool over = true;
    if (auto job = jobs_.find(job_.id)) {
        job_ = *std::move(job);
        const auto left = std::chrono::ceil<milliseconds>(give_up_ - std::chrono::steady_clock::now());
        over = has_ended(job_.state) || left.count() <= 0;
        if (!over) {
            over = log_->wait_after(reached_, std::min(left, milliseconds(500))).status ==
                   EventLog::Status::ended;
            reached_ = log_->last_id();
        }
    }
    if (!over) return {};
    // Whatever woke the wait has changed the job.
    if (auto job = jobs_.find(job_.id)) job_ = *std::move(job);
    return {dump(to_json(job_)), Piece::Then::end};
}

}  // namespace afterglow
