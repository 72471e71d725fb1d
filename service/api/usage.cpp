#include "service/api/usage.h"

#include <utility>

namespace afterglow {

class Usage::CountedStream : public ReplyStream {
  public:
    CountedStream(std::shared_ptr<ReplyStream> stream, std::shared_ptr<Tally> tally, std::string client)
        : stream_(std::move(stream)), tally_(std::move(tally)), client_(std::move(client)) {}
    ~CountedStream() override {
        const std::lock_guard lock(tally_->mutex);
        --tally_->streams[client_];
    }
    CountedStream(const CountedStream&) = delete;
    CountedStream& operator=(const CountedStream&) = delete;
    Piece next() override { return stream_->next(); }

  private:
    std::shared_ptr<ReplyStream> stream_;
    std::shared_ptr<Tally> tally_;
    std::string client_;
};

ProblemError past_quota(const std::string& what, std::int64_t limit) {
    return ProblemError(
        {429, "quota_exceeded", "more than the quota of " + std::to_string(limit) + " " + what, what});
}

/// What the client has used, where so many bytes more are within its quota. Callers hold the lock.
std::int64_t& Usage::with_room_for(const Client& client, std::size_t bytes) {
    std::int64_t& used = bytes_[client.name];
    if (static_cast<std::int64_t>(bytes) > client.quota.bytes - used)
        throw past_quota("bytes", client.quota.bytes);
    return used;
}

void Usage::check_bytes(const Client& client, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    with_room_for(client, bytes);
}

void Usage::take_bytes(const Client& client, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    with_room_for(client, bytes) += static_cast<std::int64_t>(bytes);
}

std::int64_t Usage::open_streams() const {
    const std::lock_guard lock(tally_->mutex);
    std::int64_t open = 0;
    for (const auto& [client, streams] : tally_->streams) open += streams;
    return open;
}

std::shared_ptr<ReplyStream> Usage::counted(const Client& client, std::shared_ptr<ReplyStream> stream) {
    {
        const std::lock_guard lock(tally_->mutex);
        std::int64_t& open = tally_->streams[client.name];
        if (open >= client.quota.streams) throw past_quota("streams", client.quota.streams);
        ++open;
    }
    return std::make_shared<CountedStream>(std::move(stream), tally_, client.name);
}

}  // namespace afterglow
