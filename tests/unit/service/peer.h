#pragma once

#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace afterglow {

/// A plain TCP connection to the loopback interface, that sends whatever bytes a test likes.
class Peer {
  public:
    explicit Peer(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
        const timeval longest{60, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
    }
    ~Peer() { ::close(socket_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    bool send(const std::string& bytes) const {
        return connected_ && ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
                                 static_cast<ssize_t>(bytes.size());
    }
    /// The server sees the end of what is sent; replies still come.
    void end_sending() const { ::shutdown(socket_, SHUT_WR); }
    /// All that comes until the server has nothing more to say or `enough` has come.
    std::string receive_until(const std::string& enough) const {
        std::string all;
        std::array<char, 4096> part{};
        while (all.find(enough) == std::string::npos) {
            const auto size = ::recv(socket_, part.data(), part.size(), 0);
            if (size <= 0) break;
            all.append(part.data(), static_cast<std::size_t>(size));
        }
        return all;
    }
    /// All until the server closes.
    std::string receive_all() const { return receive_until(std::string(1, '\0') + "never sent"); }

  private:
    int socket_;
    bool connected_ = false;
};

}  // namespace afterglow
