#include "solver/formfactor/static_cache.h"

#include <cstring>
#include <system_error>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace {

// Changes whenever the layout below or the meaning of a line changes.
constexpr std::uint64_t file_version = 2;
constexpr std::uint64_t file_mark = 0x30305f776f6c6741U;

struct Header {
    std::uint64_t mark = file_mark;
    std::uint64_t version = file_version;
    Hash128 key;
    std::uint64_t sight_lines = 0;
    std::uint64_t light_lines = 0;
    Hash128 checksum;  // of everything after the header
};

std::filesystem::path file_of(const std::filesystem::path& folder, const Hash128& key) {
    return folder / (key.hex() + ".lines");
}

Hash128 checksum_of(std::string_view payload) {
    Hasher hasher;
    hasher.add_bytes(payload.data(), payload.size());
    return hasher.result();
}

template <class T>
void append(std::string& out, const std::vector<T>& values) {
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
std::string_view take(std::string_view in, std::size_t count, std::vector<T>& out) {
    out.resize(count);
    std::memcpy(out.data(), in.data(), count * sizeof(T));
    return in.substr(count * sizeof(T));
}

bool targets_exist(const StaticLines& lines, Index patches) {
    for (const Index target : lines.background.patch)
        if (target >= patches && target != sees_nothing && target != sees_inside) return false;
    return true;
}

}  // namespace

Hash128 static_key(const World& world, const PatchMesh& mesh, const SightLines& lines, const Lamps& lamps,
                   Index light_lines_per_patch, std::uint64_t seed) {
    const Index patches = mesh.static_size();
    Hasher hasher;
    hasher.add(file_version);
    hasher.add(world.bodies[furniture].positions);
    for (const Triangle& triangle : world.bodies[furniture].triangles) hasher.add(triangle.vertices);
    hasher.add(patches);
    for (Index p = 0; p < patches; ++p) {
        hasher.add(mesh.centre[p]);
        hasher.add(mesh.normal[p]);
        hasher.add(mesh.area_m2[p]);
        hasher.add(mesh.surface[p]);
        hasher.add(mesh.side[p]);
    }
    hasher.add(lines.lines_per_patch());
    // The whole scene's size sets how far origins are lifted, and lamps on actors take part in the choice of
    // samples.
    hasher.add(lines.lift_m());
    hasher.add(lamps.patches);
    hasher.add(lamps.cumulative_power);
    hasher.add(light_lines_per_patch);
    hasher.add(seed);
    return hasher.result();
}

std::optional<StaticLines> load_static_lines(const std::filesystem::path& folder, const Hash128& key,
                                             const PatchMesh& mesh, Index lines_per_patch,
                                             Index light_lines_per_patch) {
    std::string file;
    try {
        file = read_file(file_of(folder, key), std::size_t{1} << 36U);
    } catch (const Error&) {
        return std::nullopt;
    }
    Header header;
    if (file.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, file.data(), sizeof header);
    const std::uint64_t sight = std::uint64_t{mesh.static_size()} * lines_per_patch;
    const std::uint64_t light = std::uint64_t{mesh.static_size()} * light_lines_per_patch;
    std::string_view payload = std::string_view(file).substr(sizeof header);
    if (header.mark != file_mark || header.version != file_version || header.key != key ||
        header.sight_lines != sight || header.light_lines != light ||
        payload.size() != sight * (sizeof(Index) + sizeof(float)) + light * sizeof(float) ||
        header.checksum != checksum_of(payload))
        return std::nullopt;
    StaticLines lines;
    payload = take(payload, sight, lines.background.patch);
    payload = take(payload, sight, lines.background.distance);
    take(payload, light, lines.light_contribution);
    lines.directions = lines_per_patch;
    // Only patches of the furniture can be seen without actors.
    if (!targets_exist(lines, mesh.static_size())) return std::nullopt;
    return lines;
}

void save_static_lines(const std::filesystem::path& folder, const Hash128& key, const StaticLines& lines) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
    std::string payload;
    append(payload, lines.background.patch);
    append(payload, lines.background.distance);
    append(payload, lines.light_contribution);
    const Header header{file_mark,
                        file_version,
                        key,
                        lines.background.patch.size(),
                        lines.light_contribution.size(),
                        checksum_of(payload)};
    std::string file(reinterpret_cast<const char*>(&header), sizeof header);
    file += payload;
    write_file(file_of(folder, key), file);
}

}  // namespace afterglow
