#include "service/base/child_process.h"

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "service/base/message_channel.h"
#include "service/base/storage_error.h"
#include "solver/base/error.h"

namespace afterglow {
namespace {

const char* const daemon_path = AFTERGLOW_BIN_DIR "/afterglowd";

TEST(ChildProcess, SaysHowItEnded) {
    ChildProcess child({}, daemon_path);
    ::kill(child.pid(), SIGSEGV);
    char byte = 0;
    EXPECT_EQ(::recv(child.socket(), &byte, 1, 0), 0) << "its end closes the socket";
    EXPECT_EQ(child.end().signal, SIGSEGV);
    EXPECT_EQ(child.end().signal, SIGSEGV) << "as often as asked";
    EXPECT_EQ(description_of(child.end()), "signal 11 (SEGV)");
    EXPECT_EQ(description_of({3, 0}), "exit status 3");
}

TEST(ChildProcess, IsKilledAtOnceFromAnotherThread) {
    ChildProcess child({}, daemon_path);
    std::thread([&] { child.kill(); }).join();
    EXPECT_EQ(child.end().signal, SIGKILL);
    child.kill();  // too late, and harmless
}

TEST(ChildProcess, GoesWithItsObject) {
    pid_t pid = 0;
    {
        const ChildProcess child({}, daemon_path);
        pid = child.pid();
    }
    EXPECT_NE(::kill(pid, 0), 0);
}

TEST(ChildProcess, GoesWithTheThreadThatMadeIt) {
    std::unique_ptr<ChildProcess> child;
    std::thread([&] {
        child = std::make_unique<ChildProcess>(ChildLimits{}, daemon_path);
        // What it does once it is tied to this thread.
        const std::string sign = "/proc/" + std::to_string(child->pid()) + "/oom_score_adj";
        for (int score = 0; score != 500; std::ifstream(sign) >> score) std::this_thread::yield();
    }).join();
    char byte = 0;
    EXPECT_EQ(::recv(child->socket(), &byte, 1, 0), 0) << "nobody else ends it";
}

TEST(ChildProcess, AProgramThatIsNotThereIsAnError) {
    EXPECT_THROW(ChildProcess({}, "/nowhere/afterglowd"), Error);
}

TEST(MessageChannel, CarriesValuesBytesAndFailures) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    const MessageChannel here(ends[0]);
    const MessageChannel there(ends[1]);
    const double number = 0.1 + 0.2;
    here.send({MessageKind::step, {{"number", number}, {"text", "ä"}}, std::string(1000, '\0')});
    const Message message = there.receive();
    EXPECT_EQ(message.kind, MessageKind::step);
    EXPECT_EQ(message.values.at("number").get<double>(), number);
    EXPECT_EQ(message.bytes, std::string(1000, '\0'));
    EXPECT_THROW(static_cast<void>(there.receive(MessageChannel::Clock::now())), ChannelTimeout);

    const auto carried = [&](const auto& thrown) {
        here.send(failure(std::make_exception_ptr(thrown)));
        throw_failure(there.receive());
    };
    EXPECT_THROW(carried(std::bad_alloc()), std::bad_alloc);
    EXPECT_THROW(carried(StorageError("disk_full", "x", "y")), StorageError);
    EXPECT_THROW(carried(std::logic_error("no")), std::runtime_error);
    try {
        carried(Error(ErrorKind::cannot_converge, "wall", "too bright"));
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::cannot_converge);
        EXPECT_STREQ(e.what(), "wall: too bright");
    }
    ::close(ends[0]);
    EXPECT_THROW(static_cast<void>(there.receive()), ChannelClosed);
    EXPECT_THROW(there.send({}), ChannelClosed);
    ::close(ends[1]);
}

TEST(MessageChannel, WhatIsNoMessageCountsAsClosed) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    ASSERT_EQ(::send(ends[0], "0123456789abcdef0123456789abcdef", 32, 0), 32);
    EXPECT_THROW(static_cast<void>(MessageChannel(ends[1]).receive()), ChannelClosed);
    ::close(ends[0]);
    ::close(ends[1]);
}

}  // namespace
}  // namespace afterglow
