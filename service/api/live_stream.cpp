#include "service/api/live_stream.h"

namespace afterglow {

namespace {
// A browser shows a part when the next boundary arrives, so each part brings the boundary that ends it.
constexpr const char* boundary = "--picture\r\n";
}  // namespace

LiveStream::LiveStream(std::string job, std::shared_ptr<const EventLog> log, const FrameStore& frames,
                       std::chrono::milliseconds wait)
    : job_(std::move(job)), log_(std::move(log)), frames_(frames), wait_(wait) {}

/// The newest picture of a frame as a part; empty where there is none.
std::string LiveStream::picture(int frame) const {
    // A final picture may replace the one found between the two calls; then its own event is on the way.
    const auto info = frames_.newest(job_, frame);
    const auto png = info ? frames_.read(job_, frame, info->revision, PictureType::png) : std::nullopt;
    if (!png) return {};
    return "Content-Type: image/png\r\nContent-Length: " + std::to_string(png->size()) + "\r\n\r\n" + *png +
           "\r\n" + boundary;
}

Piece LiveStream::next() {
    if (!has_begun_) {
        has_begun_ = true;
        return {boundary, Piece::Then::more};
    }
    int newest = -1;
    const bool waits = log_->last_id() <= reached_;
    EventLog::Batch batch = log_->wait_after(reached_, waits ? wait_ : std::chrono::milliseconds(0));
    // Everything that is there is looked through, for the sake of its last picture only.
    while (!batch.events.empty()) {
        reached_ = batch.events.back().id;
        for (const Event& event : batch.events)
            if (event.frame >= 0) newest = event.frame;
        if (batch.fill == EventLog::Fill::partial) break;
        batch = log_->wait_after(reached_, std::chrono::milliseconds(0));
    }
    if (batch.status == EventLog::Status::too_old) reached_ = log_->last_id() - 1;
    Piece piece;
    if (newest >= 0) piece.bytes = picture(newest);
    if (batch.status == EventLog::Status::ended) piece.then = Piece::Then::end;
    return piece;
}

}  // namespace afterglow
