#include "service/store/blob_store.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "service/base/identity.h"
#include "service/base/timestamp.h"
#include "service/store/durable_file.h"
#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace fs = std::filesystem;

namespace {

Timestamp shown(fs::file_time_type time) {
    return std::chrono::time_point_cast<Timestamp::duration>(std::chrono::file_clock::to_sys(time));
}

}  // namespace

BlobStore::BlobStore(fs::path folder, std::uint64_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw Error(ErrorKind::io, folder_.string(), error.message());
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename().string();
        const auto bytes = entry.file_size(error);
        if (error || !is_name(name)) {
            fs::remove(entry.path(), error);
            continue;
        }
        blobs_[name] = {bytes, entry.last_write_time(error)};
        total_ += bytes;
    }
    make_room(0);
}

bool BlobStore::is_name(std::string_view name) {
    return name.size() == 64 && name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void BlobStore::drop(const std::string& name) {
    const auto it = blobs_.find(name);
    if (it == blobs_.end()) return;
    std::error_code ignored;
    fs::remove(file_of(name), ignored);
    total_ -= it->second.bytes;
    blobs_.erase(it);
}

void BlobStore::make_room(std::uint64_t bytes) {
    while (!blobs_.empty() && total_ > max_bytes_ - bytes)
        drop(std::min_element(blobs_.begin(), blobs_.end(), [](const auto& a, const auto& b) {
                 return a.second.asked < b.second.asked;
             })->first);
}

bool BlobStore::put(const std::string& name, std::string_view content) {
    const std::lock_guard lock(mutex_);
    if (blobs_.contains(name)) return false;
    if (content.size() > max_bytes_)
        throw Error(ErrorKind::too_large, "body", "is more than all blobs may have");
    make_room(content.size());
    put_file(file_of(name), content);
    blobs_[name] = {content.size(), Time::clock::now()};
    total_ += content.size();
    return true;
}

bool BlobStore::has(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto it = blobs_.find(name);
    if (it == blobs_.end()) return false;
    it->second.asked = Time::clock::now();
    std::error_code ignored;  // known at the next start, where the disk takes it
    fs::last_write_time(file_of(name), it->second.asked, ignored);
    return true;
}

std::optional<std::string> BlobStore::get(const std::string& name) {
    if (!has(name)) return std::nullopt;
    std::string content;
    try {
        content = read_file(file_of(name));
    } catch (const Error&) {
        content.clear();  // dropped since, or damaged
    }
    if (sha256(content) == name) return content;
    const std::lock_guard lock(mutex_);
    drop(name);
    return std::nullopt;
}

std::vector<BlobStore::Entry> BlobStore::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<Entry> entries;
    for (const auto& [name, blob] : blobs_) entries.push_back({name, blob.bytes, shown(blob.asked)});
    return entries;
}

void BlobStore::remove(const Entry& entry) {
    const std::lock_guard lock(mutex_);
    const auto it = blobs_.find(entry.name);
    if (it != blobs_.end() && shown(it->second.asked) <= entry.asked) drop(entry.name);
}

}  // namespace afterglow
