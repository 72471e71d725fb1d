#include "solver/base/json.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace afterglow {

namespace {

constexpr int max_depth = 64;
// The ordered object type looks members up one by one, so that a huge object would cost its square.
constexpr std::size_t max_members = 4096;

/// One step of a JSON pointer, escaped as RFC 6901 asks.
std::string escape(std::string_view key) {
    std::string out = "/";
    for (const char c : key) {
        if (c == '~')
            out += "~0";
        else if (c == '/')
            out += "~1";
        else
            out += c;
    }
    return out;
}

/// Counts bracket nesting outside strings without building anything, so that hostile depth costs no memory.
void check_depth(std::string_view text, const std::string& source) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > max_depth)
                throw Error(ErrorKind::too_large, source,
                            "JSON nests deeper than " + std::to_string(max_depth) + " levels at byte " +
                                std::to_string(i));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

std::string shown(const Json& value) {
    std::string text = value.is_structured() ? value.type_name()
                                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 40) text = text.substr(0, 37) + "...";
    return text;
}

}  // namespace

Json parse_json(std::string_view text, const std::string& source) {
    check_depth(text, source);
    try {
        std::vector<std::size_t> members;
        const auto count_members = [&](int, Json::parse_event_t event, const Json&) {
            if (event == Json::parse_event_t::object_start) members.push_back(0);
            if (event == Json::parse_event_t::object_end) members.pop_back();
            if (event == Json::parse_event_t::key && ++members.back() > max_members)
                throw Error(ErrorKind::too_large, source,
                            "a JSON object has more than " + std::to_string(max_members) + " members");
            return true;
        };
        return Json::parse(text.begin(), text.end(), count_members);
    } catch (const Json::parse_error& e) {
        throw Error(ErrorKind::invalid_input, source, "not valid JSON at byte " + std::to_string(e.byte));
    } catch (const Json::out_of_range&) {
        throw Error(ErrorKind::invalid_input, source, "a number in the JSON is out of range");
    }
}

std::string JsonView::place() const {
    return pointer_.empty() ? source_ : source_ + "#" + pointer_;
}

void JsonView::fail(const std::string& message) const {
    throw Error(ErrorKind::invalid_input, place(), message);
}

std::optional<JsonView> JsonView::find(std::string_view key) const {
    if (!value_->is_object()) fail("expected an object, found " + shown(*value_));
    const auto it = value_->find(std::string(key));
    if (it == value_->end()) return std::nullopt;
    JsonView member(*it, source_);
    member.pointer_ = pointer_ + escape(key);
    return member;
}

JsonView JsonView::at(std::string_view key) const {
    auto member = find(key);
    if (!member) fail("the field \"" + std::string(key) + "\" is missing");
    return *std::move(member);
}

std::vector<JsonView> JsonView::elements() const {
    if (!value_->is_array()) fail("expected an array, found " + shown(*value_));
    std::vector<JsonView> out;
    out.reserve(value_->size());
    for (std::size_t i = 0; i < value_->size(); ++i) {
        JsonView element((*value_)[i], source_);
        element.pointer_ = pointer_ + "/" + std::to_string(i);
        out.push_back(std::move(element));
    }
    return out;
}

std::vector<std::pair<std::string, JsonView>> JsonView::members() const {
    if (!value_->is_object()) fail("expected an object, found " + shown(*value_));
    std::vector<std::pair<std::string, JsonView>> out;
    for (const auto& [key, value] : value_->items()) {
        JsonView member(value, source_);
        member.pointer_ = pointer_ + escape(key);
        out.emplace_back(key, std::move(member));
    }
    return out;
}

void JsonView::allow_only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, member] : members())
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) member.fail("unknown field");
}

std::string JsonView::as_string() const {
    if (!value_->is_string()) fail("expected a string, found " + shown(*value_));
    return value_->get<std::string>();
}

bool JsonView::as_bool() const {
    if (!value_->is_boolean()) fail("expected true or false, found " + shown(*value_));
    return value_->get<bool>();
}

double JsonView::as_number() const {
    if (!value_->is_number()) fail("expected a number, found " + shown(*value_));
    const double number = value_->get<double>();
    if (!std::isfinite(number)) fail("the number is not finite");
    return number;
}

double JsonView::as_number_in(double low, double high) const {
    const double number = as_number();
    if (number < low || number > high)
        fail("expected a number from " + shown(Json(low)) + " to " + shown(Json(high)) + ", found " +
             shown(*value_));
    return number;
}

std::int64_t JsonView::as_integer_in(std::int64_t low, std::int64_t high) const {
    const double number = as_number();
    // Compared as doubles first: a huge value must not wrap when converted.
    if (number != std::floor(number) || number < static_cast<double>(low) ||
        number > static_cast<double>(high))
        fail("expected a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
             ", found " + shown(*value_));
    return static_cast<std::int64_t>(number);
}

Index JsonView::as_index(std::size_t size) const {
    if (size == 0) fail("refers to an empty list");
    return static_cast<Index>(as_integer_in(0, static_cast<std::int64_t>(size) - 1));
}

std::vector<double> JsonView::as_numbers(std::size_t count) const {
    const auto items = elements();
    if (items.size() != count)
        fail("expected " + std::to_string(count) + " numbers, found " + std::to_string(items.size()));
    std::vector<double> out;
    out.reserve(count);
    for (const auto& item : items) out.push_back(item.as_number());
    return out;
}

Vec3 JsonView::as_vec3() const {
    const auto numbers = as_numbers(3);
    const Vec3 v(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                 static_cast<float>(numbers[2]));
    if (!is_finite(v)) fail("a number is too large for single precision");
    return v;
}

}  // namespace afterglow
