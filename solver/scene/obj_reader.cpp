#include "solver/scene/obj_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solver/scene/line_reader.h"
#include "solver/scene/mtl_reader.h"
#include "solver/scene/triangulate.h"

namespace afterglow {

namespace {

constexpr std::size_t max_corners = 150'000'000;

/// Statements without any effect on surfaces of flat polygons.
constexpr std::array<std::string_view, 10> without_effect{
    "vn", "s", "mg", "bevel", "lod", "usemap", "maplib", "c_interp", "d_interp", "shadow_obj"};
/// Elements other than polygons.
constexpr std::array<std::string_view, 19> not_polygons{
    "l",    "p",    "vp",   "cstype", "deg", "bmat", "step", "curv",      "curv2", "surf",
    "parm", "trim", "hole", "scrv",   "sp",  "end",  "con",  "trace_obj", "ctech"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// A corner of a polygon: positions and texture coordinates by their numbers in the file, from 0.
struct Corner {
    Index position = 0;
    Index coordinates = no_index;
};

/// The mesh of a node being filled; corners that agree share a vertex.
struct Part {
    Mesh mesh;
    bool has_coordinates = false;
    std::unordered_map<std::uint64_t, Index> vertices;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& name, const ResourceReader& read_resource,
              const LoadConfig& config)
        : config_(config), lines_(text, name), libraries_(read_resource, scene_) {
        scene_.name = name;
        const double unit = config.obj_unit_m;
        if (!std::isfinite(unit) || unit <= 0)
            throw Error(ErrorKind::invalid_input, "unit of .obj files",
                        "must be a positive number of metres");
    }

    Scene read() {
        while (lines_.next()) statement();
        if (!not_read_.empty()) {
            std::string list;
            for (const auto& word : not_read_) list += (list.empty() ? "" : ", ") + word;
            scene_.warnings.push_back({scene_.name, "only polygons are read; left out: " + list});
        }
        if (crossing_ > 0)
            scene_.warnings.push_back(
                {first_crossing_, "the outlines of " + std::to_string(crossing_) +
                                      " polygons, of which this is the first, cross themselves; their "
                                      "shapes are a guess"});
        for (Part& part : parts_) place(part);
        return std::move(scene_);
    }

  private:
    void statement() {
        const auto keyword = lines_.keyword();
        if (keyword == "v")
            positions_.push_back(position());
        else if (keyword == "vt")
            coordinates_.push_back(coordinates());
        else if (keyword == "f")
            face();
        else if (keyword == "o" || keyword == "g")
            part_ = part_named(lines_.rest());
        else if (keyword == "usemtl")
            material_ = libraries_.named(lines_.rest(), lines_.place());
        else if (keyword == "mtllib")
            libraries();
        else if (contains(not_polygons, keyword))
            not_read_.insert(std::string(keyword));
        else if (!contains(without_effect, keyword))
            lines_.fail("unknown statement " + in_quotes(keyword));
    }

    Vec3 position() {
        const auto unit = static_cast<float>(config_.obj_unit_m);
        const Vec3 p(unit * lines_.number(0), unit * lines_.number(1), unit * lines_.number(2));
        if (!is_finite(p)) lines_.fail("the vertex lies too far out for single precision");
        return config_.obj_up == UpAxis::z ? Vec3(p.x, p.z, -p.y) : p;
    }

    /// Here v points down, there it points up.
    Vec2 coordinates() {
        const float v = lines_.arguments().size() > 1 ? lines_.number(1) : 0.0F;
        return {lines_.number(0), 1 - v};
    }

    void libraries() {
        const std::string rest = lines_.rest();
        if (rest.empty()) lines_.fail("names no file");
        // Several names, or one with blanks in it: endings tell.
        const auto words = words_in(rest);
        const auto is_library = [](std::string_view word) {
            return word.size() > 4 && (word.ends_with(".mtl") || word.ends_with(".MTL"));
        };
        if (std::all_of(words.begin(), words.end(), is_library))
            for (const auto word : words) libraries_.read_library(std::string(word), lines_.place());
        else
            libraries_.read_library(rest, lines_.place());
    }

    /// Faces of a group that was left and is taken up again join the earlier ones.
    std::size_t part_named(const std::string& part_name) {
        const auto [known, is_new] = part_of_.try_emplace(part_name, parts_.size());
        if (is_new) {
            parts_.emplace_back();
            parts_.back().mesh.name = part_name;
        }
        return known->second;
    }

    /// The element that a number in a face stands for: from 1, or backwards from −1.
    Index resolved(std::string_view digits, std::size_t count, const char* what) {
        std::int64_t number = 0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (problem != std::errc() || end != digits.data() + digits.size())
            lines_.fail("expected the number of a " + std::string(what) + ", found " + in_quotes(digits));
        const auto size = static_cast<std::int64_t>(count);
        const std::int64_t index = number < 0 ? size + number : number - 1;
        if (number == 0 || index < 0 || index >= size)
            lines_.fail(std::string(what) + " " + std::to_string(number) + " does not exist; there are " +
                        std::to_string(size) + " so far");
        return static_cast<Index>(index);
    }

    /// "position", "position/coordinates", "position//normal" or "position/coordinates/normal".
    Corner corner(std::string_view word) {
        const auto first = std::min(word.find('/'), word.size());
        Corner out{resolved(word.substr(0, first), positions_.size(), "vertex"), no_index};
        if (first == word.size()) return out;
        const auto rest = word.substr(first + 1);
        const auto digits = rest.substr(0, rest.find('/'));
        if (!digits.empty()) out.coordinates = resolved(digits, coordinates_.size(), "texture vertex");
        return out;
    }

    void face() {
        if (lines_.arguments().size() < 3) lines_.fail("a face needs at least three vertices");
        corners_.clear();
        places_.clear();
        for (const auto word : lines_.arguments()) {
            corners_.push_back(corner(word));
            places_.push_back(positions_[corners_.back().position]);
        }
        if (!material_) material_ = libraries_.plain();
        if (material_->kind == ObjMaterial::Kind::opening) return;
        if (parts_.empty()) part_ = part_named("");
        count_ += corners_.size();
        if (count_ > max_corners)
            throw Error(ErrorKind::too_large, lines_.place(), "more than 50 million triangles");
        for (const auto& triangle : cut()) {
            Triangle out{{}, material_->material};
            for (std::size_t k = 0; k < 3; ++k)
                out.vertices[k] = vertex(parts_[part_], corners_[triangle[k]]);
            parts_[part_].mesh.triangles.push_back(out);
        }
    }

    std::vector<std::array<std::uint32_t, 3>> cut() {
        try {
            auto result = triangulated(places_);
            if (!result.is_simple && crossing_++ == 0) first_crossing_ = lines_.place();
            return std::move(result.triangles);
        } catch (const Error& e) {
            throw Error(e.kind(), lines_.place(), e.message());
        }
    }

    Index vertex(Part& part, const Corner& corner) {
        const std::uint64_t key = (std::uint64_t{corner.position} << 32U) | corner.coordinates;
        const auto next = static_cast<Index>(part.mesh.positions.size());
        const auto [known, is_new] = part.vertices.try_emplace(key, next);
        if (is_new) {
            part.mesh.positions.push_back(positions_[corner.position]);
            const bool has = corner.coordinates != no_index;
            part.mesh.texture_coordinates.push_back(has ? coordinates_[corner.coordinates] : Vec2(0));
            part.has_coordinates |= has;
        }
        return known->second;
    }

    /// Makes a node of a part that has faces.
    void place(Part& part) {
        if (part.mesh.triangles.empty()) return;
        if (!part.has_coordinates) part.mesh.texture_coordinates.clear();
        if (part.mesh.name.empty()) part.mesh.name = "default";
        Node node;
        node.name = part.mesh.name;
        node.mesh = static_cast<Index>(scene_.meshes.size());
        scene_.nodes.push_back(node);
        scene_.meshes.push_back(std::move(part.mesh));
    }

    const LoadConfig& config_;
    LineReader lines_;
    Scene scene_;
    MtlReader libraries_;
    std::vector<Vec3> positions_;
    std::vector<Vec2> coordinates_;
    std::vector<Part> parts_;
    std::map<std::string, std::size_t> part_of_;
    std::size_t part_ = 0;
    std::optional<ObjMaterial> material_;
    std::set<std::string> not_read_;
    std::size_t count_ = 0;
    std::size_t crossing_ = 0;
    std::string first_crossing_;
    std::vector<Corner> corners_;
    std::vector<Vec3> places_;
};

}  // namespace

Scene read_obj(std::string_view text, const std::string& name, const ResourceReader& read_resource,
               const LoadConfig& config) {
    return ObjReader(text, name, read_resource, config).read();
}

}  // namespace afterglow
