#include "solver/sequence/config.h"

#include <array>
#include <string>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr std::array<Method, 7> all_methods{{
    {"auto", Visibility::automatic, Solution::automatic, "by what the scene needs, and says which"},
    {"full", Visibility::retrace, Solution::progressive, "everything traced and solved anew at every frame"},
    {"baum86", Visibility::back_buffer, Solution::progressive,
     "static background kept, actors traced, solved anew"},
    {"chen90", Visibility::retrace, Solution::incremental,
     "everything traced, and the light corrected by what changed"},
    {"tost-pueyo93", Visibility::temporal_graph, Solution::active_passive,
     "actors in order of depth; light corrected, hidden patches of little consequence waiting"},
    {"events", Visibility::events, Solution::residual,
     "what lines come to see is found ahead, and only what changes is solved"},
    {"walkthrough", Visibility::back_buffer, Solution::in_view,
     "for a camera that moves: light is solved where it comes into view or shows there"},
}};

template <class Value>
struct Named {
    std::string_view name;
    Value value;
};
constexpr std::array<Named<Visibility>, 5> visibilities{{
    {"auto", Visibility::automatic},
    {"retrace", Visibility::retrace},
    {"back-buffer", Visibility::back_buffer},
    {"temporal-graph", Visibility::temporal_graph},
    {"events", Visibility::events},
}};
constexpr std::array<Named<Solution>, 6> solutions{{
    {"auto", Solution::automatic},
    {"progressive", Solution::progressive},
    {"incremental", Solution::incremental},
    {"active-passive", Solution::active_passive},
    {"residual", Solution::residual},
    {"in-view", Solution::in_view},
}};
constexpr std::array<Named<Quality>, 3> qualities{{
    {"draft", Quality::draft},
    {"preview", Quality::preview},
    {"final", Quality::final},
}};
constexpr std::array<Named<Estimate>, 2> estimates{{
    {"none", Estimate::none},
    {"probes", Estimate::probes},
}};

/// The entry of a table with a given name, or an error that lists the names there are.
template <class Table>
const auto& entry_named(const Table& table, std::string_view name, const char* kind) {
    std::string names;
    for (const auto& entry : table) {
        if (entry.name == name) return entry;
        if (!names.empty()) names += ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::not_found, kind,
                "there is no " + std::string(kind) + " \"" + std::string(name) + "\"; there are: " + names);
}

template <class Table, class Value>
std::string_view name_in(const Table& table, Value value) {
    for (const auto& entry : table)
        if (entry.value == value) return entry.name;
    return "unknown";
}

}  // namespace

std::span<const Method> methods() {
    return all_methods;
}
const Method& method_named(std::string_view name) {
    return entry_named(all_methods, name, "method");
}
std::string method_name(Visibility visibility, Solution solution) {
    for (const Method& method : all_methods)
        if (method.visibility == visibility && method.solution == solution) return std::string(method.name);
    return std::string(name_of(visibility)) + "+" + std::string(name_of(solution));
}
Visibility visibility_named(std::string_view name) {
    return entry_named(visibilities, name, "visibility").value;
}
Solution solution_named(std::string_view name) {
    return entry_named(solutions, name, "solution").value;
}
Quality quality_named(std::string_view name) {
    return entry_named(qualities, name, "quality").value;
}
Estimate estimate_named(std::string_view name) {
    return entry_named(estimates, name, "estimate").value;
}
std::string_view name_of(Visibility visibility) {
    return name_in(visibilities, visibility);
}
std::string_view name_of(Solution solution) {
    return name_in(solutions, solution);
}
std::string_view name_of(Estimate estimate) {
    return name_in(estimates, estimate);
}

}  // namespace afterglow
