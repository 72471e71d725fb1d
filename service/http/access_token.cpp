#include "service/http/access_token.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "service/base/identity.h"
#include "service/base/option_values.h"

namespace afterglow {

namespace {

constexpr std::size_t shortest_token = 16;
constexpr std::string_view hash_mark = "sha256:";

Role read_role(const std::string& place, const std::string& text) {
    if (text == "viewer") return Role::viewer;
    if (text == "submitter") return Role::submitter;
    if (text == "admin") return Role::admin;
    throw Error(ErrorKind::invalid_input, place,
                "expected viewer, submitter or admin, found \"" + text + "\"");
}

std::string read_hash(const std::string& place, const std::string& text) {
    if (!text.starts_with(hash_mark)) {
        if (text.size() < shortest_token)
            throw Error(ErrorKind::invalid_input, place, "a token has at least 16 characters");
        return sha256(text);
    }
    const std::string hash = text.substr(hash_mark.size());
    const bool is_hash = hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_hash)
        throw Error(ErrorKind::invalid_input, place, "expected 64 hexadecimal digits after sha256:");
    return hash;
}

void read_limit(const std::string& place, const std::string& text, Quota& quota) {
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    for (const auto& [known, field] : quota_fields)
        if (name == known && equals != std::string::npos) {
            quota.*field = whole_number(place, text.substr(equals + 1), 0, most);
            return;
        }
    throw Error(ErrorKind::invalid_input, place, "there is no limit \"" + name + "\"");
}

}  // namespace

TokenList TokenList::read(std::string_view text, const std::string& place) {
    TokenList list;
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string where = place + ":" + std::to_string(++number);
        std::istringstream words(line.substr(0, line.find('#')));
        std::string name, role, token, limit;
        if (!(words >> name)) continue;
        if (!(words >> role >> token))
            throw Error(ErrorKind::invalid_input, where, "expected NAME ROLE TOKEN");
        Entry entry{read_hash(where, token), {name, read_role(where, role), {}}};
        while (words >> limit) read_limit(where, limit, entry.client.quota);
        list.entries_.push_back(std::move(entry));
    }
    if (list.entries_.empty()) throw Error(ErrorKind::invalid_input, place, "there is no token in it");
    return list;
}

std::optional<Client> TokenList::find(std::string_view token) const {
    const std::string hash = sha256(token);
    const Entry* found = nullptr;
    for (const Entry& entry : entries_) {
        unsigned difference = 0;
        for (std::size_t i = 0; i < hash.size(); ++i)
            difference |= static_cast<unsigned char>(hash[i]) ^ static_cast<unsigned char>(entry.hash[i]);
        if (difference == 0) found = &entry;
    }
    return found == nullptr ? std::nullopt : std::optional(found->client);
}

}  // namespace afterglow
