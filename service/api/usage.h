#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "service/http/client.h"
#include "service/http/http_message.h"

namespace afterglow {

/// What each client uses of what is counted here: bytes uploaded and streams open. Thread-safety: all
/// members.
class Usage {
  public:
    /// Whether so many more could be taken. Errors as of `take_bytes`.
    void check_bytes(const Client& client, std::size_t bytes);
    /// Errors: ProblemError 429 past the client's quota.
    void take_bytes(const Client& client, std::size_t bytes);
    /// The same stream, counted as open while it lives. Errors: ProblemError 429 past the client's quota.
    std::shared_ptr<ReplyStream> counted(const Client& client, std::shared_ptr<ReplyStream> stream);

    /// Of all clients.
    [[nodiscard]] std::int64_t open_streams() const;

  private:
    struct Tally {
        std::mutex mutex;
        std::map<std::string, std::int64_t> streams;
    };
    class CountedStream;

    std::int64_t& with_room_for(const Client& client, std::size_t bytes);

    std::mutex mutex_;
    std::map<std::string, std::int64_t> bytes_;
    std::shared_ptr<Tally> tally_ = std::make_shared<Tally>();  ///< streams may outlive this object
};

/// The refusal of a request past a quota: 429 with the quota's name.
ProblemError past_quota(const std::string& what, std::int64_t limit);

}  // namespace afterglow
