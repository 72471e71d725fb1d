#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "service/jobs/edit_json.h"
#include "service/jobs/job_json.h"
#include "service/jobs/settings.h"

namespace {

/// What was read is shown as what reads the same again.
void check_settings(const afterglow::JobSettings& settings) {
    afterglow::Json shown = afterglow::to_json(settings);
    afterglow::Json given = afterglow::Json::object();
    for (const auto& [name, value] : shown.items())
        if (!value.is_null()) given[name] = value;
    const auto again = afterglow::read_settings(afterglow::JsonView(given, "again"), {});
    if (afterglow::to_json(again) != shown) std::abort();
}

void check_priority(const afterglow::Json& patch) {
    const auto priority = afterglow::read_priority(afterglow::JsonView(patch, "fuzz"));
    if (priority && (*priority < -10 || *priority > 10)) std::abort();
}

void check_edits(const afterglow::Json& request) {
    const auto edits = afterglow::read_edits(afterglow::JsonView(request, "fuzz"));
    if (edits.empty()) std::abort();
}

template <class Check>
void attempt(const Check& check) {
    try {
        check();
    } catch (const afterglow::Error&) {
        // The one way out that is allowed.
    }
}

}  // namespace

// Any text, read as a new job, as a change of one and as edits, gives values in range or an Error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    attempt([&] {
        const afterglow::Json json = afterglow::parse_json(text, "fuzz");
        attempt([&] { check_priority(json); });
        attempt([&] { check_edits(json); });
        check_settings(afterglow::read_job_request(afterglow::JsonView(json, "fuzz"), {}).settings);
    });
    return 0;
}
