#include "service/base/message_channel.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>

#include "service/base/problem.h"
#include "service/base/storage_error.h"
#include "solver/base/error.h"

namespace afterglow {

namespace {

/// Before every message; both ends are the same program on the same machine.
struct Head {
    std::uint32_t kind;
    std::uint32_t value_bytes;
    std::uint64_t bytes;
};

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32U;

bool is_ready(int socket, std::optional<MessageChannel::Clock::time_point> until) {
    for (;;) {
        int wait_ms = -1;
        if (until) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(*until - MessageChannel::Clock::now());
            if (left.count() <= 0) return false;
            wait_ms = static_cast<int>(std::min<std::int64_t>(left.count(), 1'000'000));
        }
        pollfd entry{socket, POLLIN, 0};
        if (::poll(&entry, 1, wait_ms) > 0) return true;
    }
}

}  // namespace

void MessageChannel::write(std::string_view bytes) const {
    while (!bytes.empty()) {
        const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) throw ChannelClosed();
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

void MessageChannel::read(std::span<char> to, std::optional<Clock::time_point> until) const {
    while (!to.empty()) {
        if (!is_ready(socket_, until)) throw ChannelTimeout();
        const auto received = ::recv(socket_, to.data(), to.size(), 0);
        if (received < 0 && errno == EINTR) continue;
        if (received <= 0) throw ChannelClosed();
        to = to.subspan(static_cast<std::size_t>(received));
    }
}

void MessageChannel::send(const Message& message) const {
    const auto values = Json::to_cbor(message.values);
    const Head head{static_cast<std::uint32_t>(message.kind), static_cast<std::uint32_t>(values.size()),
                    message.bytes.size()};
    write({reinterpret_cast<const char*>(&head), sizeof head});
    write({reinterpret_cast<const char*>(values.data()), values.size()});
    write(message.bytes);
}

Message MessageChannel::receive(std::optional<Clock::time_point> until) const {
    Head head{};
    read({reinterpret_cast<char*>(&head), sizeof head}, until);
    if (head.kind > static_cast<std::uint32_t>(MessageKind::failed) || head.bytes > most_bytes)
        throw ChannelClosed();
    std::string values(head.value_bytes, '\0');
    read(values, until);
    Message message;
    message.kind = static_cast<MessageKind>(head.kind);
    message.bytes.resize(head.bytes);
    read(message.bytes, until);
    message.values = Json::from_cbor(values, true, false);
    if (message.values.is_discarded()) throw ChannelClosed();
    return message;
}

Message failure(const std::exception_ptr& caught) {
    Message message{MessageKind::failed, Json::object()};
    Json& values = message.values;
    try {
        std::rethrow_exception(caught);
    } catch (const ProblemError& e) {
        const Problem& problem = e.problem();
        values = {{"status", problem.status}, {"code", problem.code}};
        values["place"] = problem.place, values["message"] = problem.detail;
    } catch (const StorageError& e) {
        values = {{"code", e.code()}, {"place", e.place()}, {"message", e.message()}};
    } catch (const Error& e) {
        values = {{"kind", static_cast<int>(e.kind())}, {"place", e.place()}, {"message", e.message()}};
    } catch (const std::bad_alloc&) {
        values["memory"] = true;
    } catch (const std::system_error& e) {
        if (e.code() == std::errc::resource_unavailable_try_again)
            values["memory"] = true;
        else
            values["message"] = e.what();
    } catch (const std::exception& e) {
        values["message"] = e.what();
    } catch (...) {
        values["message"] = "something was thrown that is no exception";
    }
    return message;
}

void throw_failure(const Message& message) {
    const Json& values = message.values;
    const auto text = [&](const char* name) { return values.value(name, ""); };
    if (values.contains("status"))
        throw ProblemError({values.at("status").get<int>(), text("code"), text("message"), text("place")});
    if (values.contains("code")) throw StorageError(text("code"), text("place"), text("message"));
    if (values.contains("kind"))
        throw Error(static_cast<ErrorKind>(values.at("kind").get<int>()), text("place"), text("message"));
    if (values.contains("memory")) throw std::bad_alloc();
    throw std::runtime_error(text("message"));
}

}  // namespace afterglow
