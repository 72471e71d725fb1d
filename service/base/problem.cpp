#include "service/base/problem.h"

#include <iostream>
#include <new>
#include <utility>

#include "service/base/console.h"
#include "service/base/storage_error.h"

namespace afterglow {

namespace {

struct Meaning {
    int status;
    std::string_view code;
};

Meaning meaning_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::invalid_input:
            return {422, "invalid_input"};
        case ErrorKind::unsupported:
            return {422, "unsupported"};
        // A name inside the request that means nothing; an unknown address is a ProblemError with 404.
        case ErrorKind::not_found:
            return {422, "not_found"};
        case ErrorKind::too_large:
            return {413, "too_large"};
        case ErrorKind::io:
            return {500, "io"};
        case ErrorKind::cancelled:
            return {409, "cancelled"};
        case ErrorKind::cannot_converge:
            return {422, "cannot_converge"};
    }
    return {500, "internal"};
}

void tell_operator(const char* what) {
    std::cerr << "afterglowd: " << one_line(what) << std::endl;
}

}  // namespace

ProblemError::ProblemError(Problem problem)
    : std::runtime_error(problem.detail), problem_(std::move(problem)) {}

std::string_view title_of(int status) {
    switch (status) {
        case 400:
            return "Bad Request";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        case 408:
            return "Request Timeout";
        case 409:
            return "Conflict";
        case 410:
            return "Gone";
        case 413:
            return "Content Too Large";
        case 414:
            return "URI Too Long";
        case 415:
            return "Unsupported Media Type";
        case 422:
            return "Unprocessable Content";
        case 401:
            return "Unauthorized";
        case 403:
            return "Forbidden";
        case 412:
            return "Precondition Failed";
        case 417:
            return "Expectation Failed";
        case 421:
            return "Misdirected Request";
        case 425:
            return "Too Early";
        case 428:
            return "Precondition Required";
        case 429:
            return "Too Many Requests";
        case 431:
            return "Request Header Fields Too Large";
        case 500:
            return "Internal Server Error";
        case 501:
            return "Not Implemented";
        case 505:
            return "HTTP Version Not Supported";
        case 507:
            return "Insufficient Storage";
        case 503:
            return "Service Unavailable";
        default:
            return status < 500 ? "Client Error" : "Server Error";
    }
}

Problem problem_of(const Error& error) {
    const Meaning meaning = meaning_of(error.kind());
    // Failures of our own disk name our own paths, which are for the operator alone.
    if (meaning.status == 500) {
        tell_operator(error.what());
        return {500, std::string(meaning.code), "the service failed to read or write its data", ""};
    }
    return {meaning.status, std::string(meaning.code), error.message(), error.place()};
}

Problem problem_of(const std::exception_ptr& caught) {
    try {
        std::rethrow_exception(caught);
    } catch (const ProblemError& e) {
        return e.problem();
    } catch (const StorageError& e) {
        Problem problem = problem_of(static_cast<const Error&>(e));
        problem.code = e.code();
        if (e.code() == "disk_full") problem.status = 507, problem.detail = "the service's disk is full";
        if (e.code() == "disk_read_only") problem.detail = "the service cannot write to its disk";
        return problem;
    } catch (const Error& e) {
        return problem_of(e);
    } catch (const std::bad_alloc&) {
        return {503, "out_of_memory", "not enough memory for this request", ""};
    } catch (const std::exception& e) {
        tell_operator(e.what());
    } catch (...) {
        tell_operator("something was thrown that is no exception");
    }
    return {500, "internal", "the service failed; this is a defect of the service, not of the request", ""};
}

Json to_json(const Problem& problem) {
    Json json = {{"type", "about:blank"},
                 {"title", title_of(problem.status)},
                 {"status", problem.status},
                 {"code", problem.code},
                 {"detail", problem.detail}};
    if (!problem.place.empty()) json["place"] = problem.place;
    return json;
}

}  // namespace afterglow
