#include "tests/unit/service/zip_builder.h"

#include <stdexcept>
#include <zip.h>

namespace afterglow {

namespace {
void check(bool holds) {
    if (!holds) throw std::runtime_error("the archive could not be made");
}
}  // namespace

std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files,
                   const std::string& password) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
    check(target != nullptr);
    zip_source_keep(target);
    zip_t* archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
    check(archive != nullptr);
    for (const auto& [name, content] : files) {
        if (name.ends_with('/')) {
            check(zip_dir_add(archive, name.c_str(), ZIP_FL_ENC_UTF_8) >= 0);
            continue;
        }
        zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
        const auto index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
        check(index >= 0);
        if (!password.empty())
            check(zip_file_set_encryption(archive, static_cast<zip_uint64_t>(index), ZIP_EM_AES_256,
                                          password.c_str()) == 0);
    }
    check(zip_close(archive) == 0);
    check(zip_source_open(target) == 0);
    zip_stat_t about;
    check(zip_source_stat(target, &about) == 0);
    std::string bytes(about.size, '\0');
    check(zip_source_read(target, bytes.data(), bytes.size()) == static_cast<zip_int64_t>(bytes.size()));
    zip_source_close(target);
    zip_source_free(target);
    return bytes;
}

}  // namespace afterglow
