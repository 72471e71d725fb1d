#include "service/store/frame_store.h"

#include <set>
#include <system_error>
#include <utility>

#include "service/store/durable_file.h"
#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace {

namespace fs = std::filesystem;

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
}
}  // namespace

FrameStore::FrameStore(std::filesystem::path folder, FrameJournal* journal)
    : folder_(std::move(folder)), journal_(journal) {
    make_folder(folder_);
    if (journal_ != nullptr) sweep();
}

/// Removes files that the journal does not know: they are of frames that were not finished when the process
/// ended.
void FrameStore::sweep() {
    std::error_code error;
    std::vector<fs::path> unknown;
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
        std::set<fs::path> known;
        const std::string job = entry.path().filename().string();
        for (const auto& [frame, info] : durable(job))
            for (const auto type : {PictureType::png, PictureType::exr})
                known.insert(file_of(job, frame, info.revision, type));
        for (const auto& file : fs::directory_iterator(entry.path(), error))
            if (!known.contains(file.path())) unknown.push_back(file.path());
        if (known.empty()) unknown.push_back(entry.path());
    }
    for (const fs::path& path : unknown) fs::remove(path, error);
}

/// What the journal knows of a job.
FrameStore::Frames FrameStore::durable(const std::string& job) const {
    Frames frames;
    // One that an edit made stale may have gone before its successor was durable.
    for (const FrameInfo& info : journal_->frames_of(job))
        if (fs::exists(file_of(job, info.frame, info.revision, PictureType::png))) frames[info.frame] = info;
    return frames;
}

/// Callers hold the lock.
FrameStore::Frames FrameStore::frames_of(const std::string& job) const {
    if (const auto it = newest_.find(job); it != newest_.end()) return it->second;
    return journal_ == nullptr ? Frames() : durable(job);
}

/// The frames of a job that goes on. Callers hold the lock.
FrameStore::Frames& FrameStore::loaded(const std::string& job) {
    if (const auto it = newest_.find(job); it != newest_.end()) return it->second;
    Frames frames = frames_of(job);
    for (const auto& [frame, info] : frames) revisions_[job][frame] = {info.revision};
    return newest_[job] = std::move(frames);
}

void FrameStore::rest(const std::string& job) {
    if (journal_ == nullptr) return;
    const std::lock_guard lock(mutex_);
    const Frames newest = std::exchange(newest_[job], {});
    const auto stored = std::exchange(revisions_[job], {});
    newest_.erase(job);
    revisions_.erase(job);
    const Frames kept = durable(job);
    std::error_code ignored;  // what stays is removed at the next start
    for (const auto& [frame, info] : newest) {
        if (info.final) continue;
        for (const int revision : stored.at(frame)) {
            const auto known = kept.find(frame);
            if (known != kept.end() && known->second.revision == revision) continue;
            for (const auto type : {PictureType::png, PictureType::exr})
                fs::remove(file_of(job, frame, revision, type), ignored);
        }
    }
}

std::size_t FrameStore::jobs_in_memory() const {
    const std::lock_guard lock(mutex_);
    return newest_.size();
}

void FrameStore::flush() {
    if (journal_ != nullptr) journal_->flush();
}

std::uint64_t FrameStore::bytes_of(const std::string& job) const {
    std::error_code error;
    std::uint64_t bytes = 0;
    for (fs::directory_iterator it(folder_ / job, error), end; it != end && !error; it.increment(error))
        if (const auto size = it->file_size(error); !error) bytes += size;
    return bytes;
}

fs::path FrameStore::set_aside(const std::string& job) {
    const std::lock_guard lock(mutex_);
    newest_.erase(job);
    revisions_.erase(job);
    const fs::path aside = folder_ / (job + ".removed-" + std::to_string(++aside_));
    std::error_code error;
    fs::rename(folder_ / job, aside, error);
    return error ? fs::path() : aside;
}

void FrameStore::remove(const std::string& job) {
    std::error_code ignored;  // what cannot be removed now is removed at the next start
    if (const fs::path aside = set_aside(job); !aside.empty()) fs::remove_all(aside, ignored);
}

std::filesystem::path FrameStore::file_of(const std::string& job, int frame, int revision,
                                          PictureType type) const {
    std::string number = std::to_string(frame);
    if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
    return folder_ / job /
           ("frame_" + number + "." + std::to_string(revision) +
            (type == PictureType::png ? ".png" : ".exr"));
}

void FrameStore::put(const std::string& job, const FrameInfo& info, const EncodedPicture& picture) {
    make_folder(folder_ / job);
    const fs::path png = file_of(job, info.frame, info.revision, PictureType::png);
    const fs::path exr = file_of(job, info.frame, info.revision, PictureType::exr);
    put_file(png, picture.png);
    put_file(exr, picture.exr);
    {
        const std::lock_guard lock(mutex_);
        loaded(job)[info.frame] = info;
        revisions_[job][info.frame].insert(info.revision);
    }
    if (!info.final) return;
    if (journal_ != nullptr) journal_->add({job, info, {png, exr}});
    remove_earlier(job, info);
}

void FrameStore::remove_earlier(const std::string& job, const FrameInfo& final_info) {
    std::set<int> earlier;
    {
        const std::lock_guard lock(mutex_);
        const auto known = revisions_.find(job);
        if (known != revisions_.end())
            earlier = std::exchange(known->second[final_info.frame], {final_info.revision});
    }
    earlier.erase(final_info.revision);
    std::error_code ignored;  // a file that is gone already is as good as removed
    for (const int revision : earlier)
        for (const auto type : {PictureType::png, PictureType::exr})
            std::filesystem::remove(file_of(job, final_info.frame, revision, type), ignored);
}

std::vector<FrameInfo> FrameStore::newest(const std::string& job) const {
    const std::lock_guard lock(mutex_);
    std::vector<FrameInfo> frames;
    for (const auto& [frame, info] : frames_of(job)) frames.push_back(info);
    return frames;
}

std::optional<FrameInfo> FrameStore::newest(const std::string& job, int frame) const {
    const std::lock_guard lock(mutex_);
    const auto held = newest_.find(job);
    const Frames asked = held == newest_.end() ? frames_of(job) : Frames();
    const Frames& frames = held == newest_.end() ? asked : held->second;
    const auto found = frames.find(frame);
    return found == frames.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::string> FrameStore::read(const std::string& job, int frame, int revision,
                                            PictureType type) const {
    try {
        return read_file(file_of(job, frame, revision, type));
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::not_found) return std::nullopt;
        throw;
    }
}

}  // namespace afterglow
