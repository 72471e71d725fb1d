#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "service/http/http_message.h"
#include "service/jobs/event_log.h"
#include "service/store/job_store.h"

namespace afterglow {

/// A job's JSON, sent once the job has ended or the time is over: a stream, so that those who wait count
/// among them.
class JobWait : public ReplyStream {
  public:
    /// The store must outlive the stream.
    JobWait(const JobStore& jobs, Job job, std::shared_ptr<const EventLog> log, std::chrono::seconds longest);
    Piece next() override;

  private:
    const JobStore& jobs_;
    Job job_;  ///< as last seen
    std::shared_ptr<const EventLog> log_;
    std::uint64_t reached_;
    std::chrono::steady_clock::time_point give_up_;
};

}  // namespace afterglow
