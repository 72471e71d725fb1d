#pragma once

#include <string>

#include "client/error.h"
#include "client/http.h"
#include "client/json.h"

namespace afterglow::client {

/// What a 404 means to the caller: a job that is not there, or input that names something that is not there.
enum class NotFound { not_found, bad_input };

/// "place: detail" of an RFC 9457 problem object, on one line; what there is of them.
std::string problem_line(const Json& problem);

/// The error that a reply with a status of 400 or more stands for: a problem object's place and detail where
/// it has one, else the server and the status. 4xx is bad_input (404 as `not_found` says), the rest
/// no_server; so is any 4xx that is no problem object, since then something else than our service answered.
ClientError error_of(const HttpReply& reply, const std::string& server, NotFound not_found);

/// The JSON body of a successful reply. Errors: as error_of; no_server where the body is no JSON object.
Json json_reply(const HttpReply& reply, const std::string& server, NotFound not_found = NotFound::not_found);

}  // namespace afterglow::client
