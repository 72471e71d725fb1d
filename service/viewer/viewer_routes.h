#pragma once

#include "service/http/router.h"

namespace afterglow {

/// Adds the page at `/` and its files below `/viewer/`. They are the same for everybody and hold no data:
/// what the page shows it asks the interface for, under the interface's rules.
void add_viewer_routes(Router& router);

}  // namespace afterglow
