#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/http/access_token.h"
#include "service/http/http_server.h"

namespace afterglow {

struct GateConfig {
    std::vector<std::string> hosts;           ///< names this service is reached by, besides localhost
    std::shared_ptr<const TokenList> tokens;  ///< null: everybody may do everything
};

/// Whether an address can be reached from this machine only. Names other than localhost count as reachable.
bool is_loopback(const std::string& address);

/// Decides who may ask for what, from a request's head alone:
/// - Host must be an IP address, localhost or a known name, also on loopback: a page elsewhere whose name is
///   made to point here would otherwise be of the same origin (DNS rebinding);
/// - Origin, where given, must be this service; requests that a browser makes for other sites are refused;
/// - with tokens, everything but /healthz, /readyz and the page's files needs one, as
///   `Authorization: Bearer TOKEN` or as the cookie `afterglow_token`; changes need the role submitter.
Gate make_gate(GateConfig config);

}  // namespace afterglow
