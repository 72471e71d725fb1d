#pragma once

#include <string>

#include <gtest/gtest.h>

#include "service/http/http_message.h"

namespace afterglow {

/// What a reply's stream gives until its end; the test fails where the reply has none.
inline std::string read_to_end(const Reply& reply) {
    std::string all;
    EXPECT_NE(reply.stream, nullptr) << reply.body;
    for (bool more = reply.stream != nullptr; more;) {
        const Piece piece = reply.stream->next();
        all += piece.bytes;
        more = piece.then == Piece::Then::more;
    }
    return all;
}

}  // namespace afterglow
