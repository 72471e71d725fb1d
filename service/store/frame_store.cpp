#include "service/store/frame_store.h"

#include <system_error>
#include <utility>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace {
void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
}
}  // namespace

FrameStore::FrameStore(std::filesystem::path folder) : folder_(std::move(folder)) {
    make_folder(folder_);
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
    write_file(file_of(job, info.frame, info.revision, PictureType::png), picture.png);
    write_file(file_of(job, info.frame, info.revision, PictureType::exr), picture.exr);
    {
        const std::lock_guard lock(mutex_);
        newest_[job][info.frame] = info;
    }
    if (info.final) remove_preliminary(job, info);
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
