#include "solver/scene/bundle.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <utility>

#include "solver/base/json.h"

namespace afterglow {

namespace {

constexpr std::string_view first_line = "afterglow bundle 1\n";
constexpr std::size_t longest_name = 500;

bool is_plain_part(std::string_view part) {
    return !part.empty() && part != "." && part != "..";
}

bool is_utf8(std::string_view text) {
    return Json::accept("\"" + std::string(text) + "\"");
}

}  // namespace

bool is_plain_path(std::string_view name) {
    if (name.empty() || name.size() > longest_name) return false;
    const bool is_odd = std::any_of(name.begin(), name.end(), [](unsigned char c) {
        return c < 32 || c == 127 || c == '\\' || c == ':' || c == '"';
    });
    if (is_odd || !is_utf8(name)) return false;
    for (;;) {
        const auto slash = name.find('/');
        if (!is_plain_part(name.substr(0, slash))) return false;
        if (slash == std::string_view::npos) return true;
        name.remove_prefix(slash + 1);
    }
}

std::string pack(const Bundle& bundle) {
    Json files = Json::array();
    std::size_t size = 0;
    for (const auto& [name, content] : bundle.files) {
        files.push_back({name, content.size()});
        size += content.size();
    }
    const Json head = {{"main", bundle.main}, {"files", std::move(files)}};
    std::string bytes = std::string(first_line) + head.dump() + "\n";
    bytes.reserve(bytes.size() + size);
    for (const auto& [name, content] : bundle.files) bytes += content;
    return bytes;
}

Bundle unpack(std::string_view bytes, const std::string& name) {
    const auto fail = [&](const char* why) { throw Error(ErrorKind::invalid_input, name, why); };
    if (!bytes.starts_with(first_line)) fail("is no bundle of files");
    bytes.remove_prefix(first_line.size());
    const auto end = bytes.find('\n');
    if (end == std::string_view::npos) fail("is cut off");
    const Json head = parse_json(bytes.substr(0, end), name);
    bytes.remove_prefix(end + 1);

    Bundle bundle;
    const JsonView view(head, name);
    bundle.main = view.at("main").as_string();
    for (const JsonView& file : view.at("files").elements()) {
        const auto pair = file.elements();
        if (pair.size() != 2) file.fail("expected a name and a size");
        const std::string file_name = pair[0].as_string();
        if (!is_plain_path(file_name)) pair[0].fail("expected a path inside the bundle");
        const auto size =
            static_cast<std::size_t>(pair[1].as_integer_in(0, std::numeric_limits<std::int64_t>::max()));
        if (size > bytes.size()) pair[1].fail("the bundle is cut off");
        if (!bundle.files.emplace(file_name, bytes.substr(0, size)).second)
            pair[0].fail("is there more than once");
        bytes.remove_prefix(size);
    }
    if (!bytes.empty()) fail("is longer than its files");
    if (!bundle.files.contains(bundle.main)) fail("does not hold its own scene");
    return bundle;
}

ResourceReader resources_of(const Bundle& bundle) {
    const auto folder = std::filesystem::path(bundle.main).parent_path();
    return [folder, files = bundle.files](const std::string& uri) {
        const auto found = files.find((folder / relative_path(uri)).generic_string());
        if (found == files.end())
            throw Error(ErrorKind::not_found, in_quotes(uri), "no such file came with the scene");
        return std::string(found->second);
    };
}

}  // namespace afterglow
