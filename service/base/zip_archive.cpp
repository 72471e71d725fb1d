#include "service/base/zip_archive.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <zip.h>

#include "solver/base/error.h"

namespace afterglow {

namespace {

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct Close {
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, Discard>;
using File = std::unique_ptr<zip_file_t, Close>;

struct Entry {
    zip_uint64_t index = 0;
    std::string name;
    std::size_t bytes = 0;
};

Error damaged(const std::string& place, const std::string& why) {
    return {ErrorKind::invalid_input, place, why};
}

Archive open_archive(std::string_view bytes, const std::string& place) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    zip_t* archive =
        source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error);
    if (archive == nullptr) {
        zip_source_free(source);
        zip_error_fini(&error);
        throw damaged(place, "is no zip archive, or a damaged one");
    }
    zip_error_fini(&error);
    return Archive(archive);
}

/// What the archive says of one of its files; nothing for a folder.
std::optional<Entry> entry_of(zip_t* archive, zip_uint64_t index, const std::string& place) {
    zip_stat_t about;
    constexpr zip_uint64_t needed =
        ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    if (zip_stat_index(archive, index, 0, &about) != 0 || (about.valid & needed) != needed)
        throw damaged(place, "has a damaged list of files");
    Entry entry{index, about.name, 0};
    if (entry.name.ends_with('/') && about.size == 0) return std::nullopt;
    if (about.encryption_method != ZIP_EM_NONE)
        throw Error(ErrorKind::unsupported, place + "/" + entry.name, "is encrypted");
    if (zip_compression_method_supported(static_cast<zip_int32_t>(about.comp_method), 0) == 0)
        throw Error(ErrorKind::unsupported, place + "/" + entry.name, "is compressed in an unknown way");
    entry.bytes = static_cast<std::size_t>(about.size);
    return entry;
}

std::string content_of(zip_t* archive, const Entry& entry, const std::string& place) {
    const File file(zip_fopen_index(archive, entry.index, 0));
    std::string content(entry.bytes, '\0');
    std::size_t done = 0;
    while (file && done < content.size()) {
        const auto size = zip_fread(file.get(), content.data() + done, content.size() - done);
        if (size <= 0) break;
        done += static_cast<std::size_t>(size);
    }
    // Reading the end is also what compares the checksum.
    char more = 0;
    if (!file || done < content.size() || zip_fread(file.get(), &more, 1) != 0)
        throw damaged(place + "/" + entry.name, "is damaged");
    return content;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> read_zip(std::string_view bytes, const ZipLimits& limits,
                                                          const std::string& place) {
    const Archive archive = open_archive(bytes, place);
    const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
    if (count < 0) throw damaged(place, "has a damaged list of files");
    if (static_cast<std::uint64_t>(count) > limits.files)
        throw Error(ErrorKind::too_large, place,
                    "holds more than the limit of " + std::to_string(limits.files) + " files");
    std::vector<Entry> entries;
    std::size_t left = limits.bytes;
    for (zip_int64_t i = 0; i < count; ++i) {
        const auto entry = entry_of(archive.get(), static_cast<zip_uint64_t>(i), place);
        if (!entry) continue;
        if (entry->bytes > left)
            throw Error(ErrorKind::too_large, place,
                        "unpacks to more than the limit of " + std::to_string(limits.bytes) + " bytes");
        left -= entry->bytes;
        entries.push_back(*entry);
    }
    std::vector<std::pair<std::string, std::string>> files;
    files.reserve(entries.size());
    for (const Entry& entry : entries)
        files.emplace_back(entry.name, content_of(archive.get(), entry, place));
    return files;
}

}  // namespace afterglow
