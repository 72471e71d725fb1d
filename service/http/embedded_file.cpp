#include "service/http/embedded_file.h"

#include <functional>
#include <string>

namespace afterglow {

Reply file_reply(const Request& request, const EmbeddedFile& file) {
    const std::string tag = '"' + std::to_string(std::hash<std::string_view>{}(file.bytes)) + '"';
    Reply reply;
    reply.headers = {{"Cache-Control", "no-cache"}, {"ETag", tag}};
    if (request.header("if-none-match") == tag) {
        reply.status = 304;
        return reply;
    }
    reply.content_type = file.content_type;
    reply.body = file.bytes;
    return reply;
}

}  // namespace afterglow
