#include "solver/scene/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "solver/base/other_pictures.h"
#include "solver/base/pixels.h"
#include "solver/scene/line_reader.h"
#include "solver/scene/texture.h"

namespace afterglow {

namespace {

constexpr std::uint64_t max_texels = std::uint64_t{128} << 20U;

/// Statements that say nothing about a diffuse surface, or nothing that changes how it looks here.
constexpr std::array<std::string_view, 5> without_effect{"Ka", "Ns", "Ni", "sharpness", "map_Ka"};

/// The file name of a map statement, after its options, and whether there were options.
struct MapArguments {
    std::string file;
    bool has_options = false;
};

/// How many arguments an option takes; -o, -s and -t take one to three numbers.
std::size_t arguments_of(std::string_view option, const std::vector<std::string_view>& words, std::size_t k) {
    if (option == "-mm") return 2;
    if (option != "-o" && option != "-s" && option != "-t") return 1;
    std::size_t count = 0;
    while (count < 3 && k + 1 + count < words.size() &&
           words[k + 1 + count].find_first_not_of("+-.0123456789eE") == std::string_view::npos)
        ++count;
    return count;
}

MapArguments map_arguments(const LineReader& lines) {
    const auto& words = lines.arguments();
    std::size_t k = 0;
    while (k < words.size() && words[k].size() > 1 && words[k][0] == '-')
        k += 1 + arguments_of(words[k], words, k);
    if (k >= words.size()) lines.fail("names no picture");
    // From the first word of the name to the end of the line: names may contain blanks.
    const std::string rest = lines.rest();
    const auto last_words = words_in(rest);
    if (k >= last_words.size()) return {std::string(words[k]), k > 0};
    return {rest.substr(static_cast<std::size_t>(last_words[k].data() - rest.data())), k > 0};
}

/// A material as far as its statements have been read.
struct Draft {
    Material material;
    Index emission_map = no_index;
    float opacity = 1;
    bool is_glass = false;
};

Rgb colour(const LineReader& lines) {
    if (lines.arguments().empty() || lines.arguments()[0] == "spectral" || lines.arguments()[0] == "xyz")
        lines.fail("only colours given as red, green and blue are read");
    const float red = lines.number(0);
    const Rgb out = lines.arguments().size() == 1 ? Rgb(red) : Rgb(red, lines.number(1), lines.number(2));
    if (std::min({out.r, out.g, out.b}) < 0) lines.fail("a colour must not be negative");
    return out;
}

}  // namespace

/// One library being read.
class MtlReader::Library {
  public:
    Library(MtlReader& owner, std::string_view text, const std::string& file)
        : owner_(owner), file_(file), lines_(text, file) {}

    void read() {
        while (lines_.next()) statement();
        finish();
        warn_once(glossy_, "highlights (Ks) are left out, the surfaces are diffuse: ");
        warn_once(left_out_, "left out, as it does not bear on a diffuse surface: ");
    }

  private:
    void statement() {
        const auto keyword = lines_.keyword();
        if (keyword == "newmtl") {
            finish();
            if (lines_.rest().empty()) lines_.fail("names no material");
            current_.emplace();
            current_->material.name = lines_.rest();
            place_ = lines_.place();
            return;
        }
        if (!current_) lines_.fail("comes before the first newmtl");
        if (keyword == "Kd")
            current_->material.reflectance = colour(lines_);
        else if (keyword == "Ke")
            current_->material.emission = colour(lines_);
        else if (keyword == "map_Kd")
            current_->material.texture = map();
        else if (keyword == "map_Ke")
            current_->emission_map = map();
        else if (keyword == "d")
            opacity(lines_.number(argument_after_halo()));
        else if (keyword == "Tr")
            opacity(1 - lines_.number(0));
        else if (keyword == "illum")
            illumination();
        else if (keyword == "Ks")
            shiny(colour(lines_));
        else if (std::find(without_effect.begin(), without_effect.end(), keyword) == without_effect.end())
            left_out_.insert(in_quotes(keyword));
    }

    [[nodiscard]] std::size_t argument_after_halo() const {
        return !lines_.arguments().empty() && lines_.arguments()[0] == "-halo" ? 1 : 0;
    }

    void opacity(float value) { current_->opacity = value; }

    /// Models 6, 7 and 9 are glass; 4 is too, but some exporters write it for every material.
    void illumination() {
        const float model = lines_.number(0);
        if (model == 6 || model == 7 || model == 9) current_->is_glass = true;
    }

    void shiny(const Rgb& specular) {
        if (max_channel(specular) > 0) glossy_.insert(in_quotes(current_->material.name));
    }

    Index map() {
        const auto [file, has_options] = map_arguments(lines_);
        if (has_options) left_out_.insert("options of " + in_quotes(lines_.keyword()));
        return owner_.texture(file, lines_.place());
    }

    /// Puts the material just read into the scene.
    void finish() {
        if (!current_) return;
        auto& [material, emission_map, opacity, is_glass] = *current_;
        if (emission_map != no_index) {
            material.emission *= mean_colour(owner_.scene_.textures[emission_map]);
            owner_.scene_.warnings.push_back(
                {place_, "emission by a picture: the surface shines evenly in its mean colour"});
        }
        const auto [known, is_new] = owner_.materials_.try_emplace(material.name);
        if (is_new) {
            known->second.material = static_cast<Index>(owner_.scene_.materials.size());
            // What emits is a lamp before it is a pane.
            if ((opacity < 0.5F || is_glass) && !(max_channel(material.emission) > 0)) {
                known->second.kind = ObjMaterial::Kind::opening;
                owner_.scene_.warnings.push_back(
                    {place_, "the material " + in_quotes(material.name) +
                                 " lets light through: its faces are left out as openings"});
            }
            owner_.scene_.materials.push_back(std::move(material));
        }
        current_.reset();
    }

    /// One warning for everything of a kind in this library.
    void warn_once(const std::set<std::string>& what, const std::string& message) {
        if (what.empty()) return;
        constexpr std::size_t shown = 5;
        std::string list;
        std::size_t count = 0;
        for (const auto& name : what)
            if (count++ < shown) list += (list.empty() ? "" : ", ") + name;
        if (count > shown) list += " and " + std::to_string(count - shown) + " more";
        owner_.scene_.warnings.push_back({file_, message + list});
    }

    MtlReader& owner_;
    std::string file_;
    LineReader lines_;
    std::optional<Draft> current_;
    std::string place_;
    std::set<std::string> glossy_;
    std::set<std::string> left_out_;
};

std::string MtlReader::read(const std::string& file, const std::string& place) {
    if (!read_resource_)
        throw Error(
            ErrorKind::invalid_input, place,
            "refers to the file " + in_quotes(file) + "; a scene sent by itself must contain everything");
    // File names here are no URIs: a percent sign stands for itself.
    std::string uri;
    for (const char c : file) uri += c == '%' ? std::string("%25") : std::string(1, c);
    try {
        return read_resource_(uri);
    } catch (const Error& e) {
        throw Error(e.kind(), place, e.what());
    }
}

Index MtlReader::texture(const std::string& file, const std::string& place) {
    const auto known = textures_.find(file);
    if (known != textures_.end()) return known->second;
    Bytes8 pixels = decode_texture(read(file, place), place);
    texels_ += pixels.rgba.size() / 4;
    if (texels_ > max_texels)
        throw Error(ErrorKind::too_large, place, "the textures have more than 128 Mi pixels in all");
    const auto index = static_cast<Index>(scene_.textures.size());
    scene_.textures.push_back({file, pixels.width, pixels.height, std::move(pixels.rgba)});
    textures_.emplace(file, index);
    return index;
}

void MtlReader::read_library(const std::string& file, const std::string& place) {
    const std::string text = read(file, place);
    Library(*this, text, file).read();
}

ObjMaterial MtlReader::plain() {
    const auto [known, is_new] = materials_.try_emplace("");
    if (is_new) {
        known->second.material = static_cast<Index>(scene_.materials.size());
        scene_.materials.emplace_back().name = "default";
    }
    return known->second;
}

ObjMaterial MtlReader::named(const std::string& name, const std::string& place) {
    if (name.empty()) throw Error(ErrorKind::invalid_input, place, "names no material");
    const auto [known, is_new] = materials_.try_emplace(name);
    if (is_new) {
        known->second.material = static_cast<Index>(scene_.materials.size());
        scene_.materials.emplace_back().name = name;
        scene_.warnings.push_back(
            {place, "no library has the material " + in_quotes(name) + "; it is taken as plain grey"});
    }
    return known->second;
}

}  // namespace afterglow
