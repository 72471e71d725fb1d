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
    if (journal_ != nullptr) load();
}

/// Takes what the journal knows. Other files are of frames that were not finished when the process ended.
void FrameStore::load() {
    std::set<fs::path> known;
    for (const auto& [job, frames] : journal_->load())
        for (const FrameInfo& info : frames) {
            newest_[job][info.frame] = info;
            for (const auto type : {PictureType::png, PictureType::exr})
                known.insert(file_of(job, info.frame, info.revision, type));
        }
    std::error_code error;
    std::vector<fs::path> unknown;
    for (fs::recursive_directory_iterator it(folder_, error), end; it != end && !error; it.increment(error))
        if (it->is_regular_file(error) && !known.contains(it->path())) unknown.push_back(it->path());
    for (const fs::path& path : unknown) fs::remove(path, error);
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

void FrameStore::remove(const std::string& job) {
    {
        const std::lock_guard lock(mutex_);
        newest_.erase(job);
    }
    std::error_code ignored;  // what cannot be removed now is removed at the next start
    fs::remove_all(folder_ / job, ignored);
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
        newest_[job][info.frame] = info;
    }
    if (!info.final) return;
    if (journal_ != nullptr) journal_->add({job, info, {png, exr}});
    remove_preliminary(job, info);
}

void FrameStore::remove_preliminary(const std::string& job, const FrameInfo& final_info) const {
    std::error_code ignored;  // a file that is gone already is as good as removed
    for (int revision = 1; revision < final_info.revision; ++revision)
        for (const auto type : {PictureType::png, PictureType::exr})
            std::filesystem::remove(file_of(job, final_info.frame, revision, type), ignored);
}

std::vector<FrameInfo> FrameStore::newest(const std::string& job) const {
    const std::lock_guard lock(mutex_);
    std::vector<FrameInfo> frames;
    if (const auto it = newest_.find(job); it != newest_.end())
        for (const auto& [frame, info] : it->second) frames.push_back(info);
    return frames;
}

std::optional<FrameInfo> FrameStore::newest(const std::string& job, int frame) const {
    const std::lock_guard lock(mutex_);
    const auto it = newest_.find(job);
    if (it == newest_.end()) return std::nullopt;
    const auto found = it->second.find(frame);
    if (found == it->second.end()) return std::nullopt;
    return found->second;
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
