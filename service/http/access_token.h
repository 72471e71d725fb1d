#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/http/http_message.h"

namespace afterglow {

/// The tokens of a file, one a line: `NAME ROLE TOKEN [LIMIT=NUMBER …]`, `#` begins a comment. ROLE is
/// viewer, submitter or admin; TOKEN is the token, 16 bytes or more, or `sha256:` and its hash in
/// hexadecimal; LIMIT is a field of Quota. Only hashes are kept in memory. Thread-safety: const.
class TokenList {
  public:
    /// Errors: invalid_input naming `place` and the line.
    static TokenList read(std::string_view text, const std::string& place);

    /// Whose token this is. Takes the same time for every wrong one.
    [[nodiscard]] std::optional<Client> find(std::string_view token) const;
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

  private:
    struct Entry {
        std::string hash;  ///< 64 hexadecimal digits
        Client client;
    };
    std::vector<Entry> entries_;
};

}  // namespace afterglow
