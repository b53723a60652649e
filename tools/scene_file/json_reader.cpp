#include "tools/scene_file/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
constexpr std::size_t kShown = 40;  // letters of a value in a message

std::string shown(const SceneJson& json)
{
    if (json.is_array()) return "an array of " + std::to_string(json.size());
    if (json.is_object()) return "an object";
    std::string text = json.dump(-1, ' ', false, SceneJson::error_handler_t::replace);
    if (text.size() > kShown) text = text.substr(0, kShown) + "...";
    return text;
}

std::string shortText(double number)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

std::string rangeText(const Limits& limits)
{
    return " from " + shortText(limits.m_least) + " to " + shortText(limits.m_most);
}

// The library's message without its own name and numbers.
std::string plainText(const std::string& message)
{
    const std::size_t at = message.find("at line ");
    return "not JSON: " + (at == std::string::npos ? message : message.substr(at));
}
}  // namespace

SceneMistake::SceneMistake(const std::string& path, const std::string& text)
    : std::runtime_error((path.empty() ? "/" : path) + ": " + text)
{
}

void JsonValue::refuse(const std::string& expected) const
{
    fail("expected " + expected + ", found " + shown(*m_json));
}

double JsonValue::number(const Limits& limits) const
{
    const double value = m_json->is_number() ? m_json->get<double>() : NAN;
    if (!(value >= limits.m_least && value <= limits.m_most)) refuse("a number" + rangeText(limits));
    return value;
}

int JsonValue::whole(int least, int most) const
{
    const double value = m_json->is_number() ? m_json->get<double>() : NAN;
    if (!(value >= least && value <= most && value == std::floor(value)))
        refuse("a whole number" + rangeText({double(least), double(most)}));
    return static_cast<int>(value);
}

bool JsonValue::truth() const
{
    if (!m_json->is_boolean()) refuse("true or false");
    return m_json->get<bool>();
}

std::string JsonValue::text() const
{
    if (!m_json->is_string() || m_json->get_ref<const std::string&>().empty()) refuse("a text");
    return m_json->get<std::string>();
}

std::string JsonValue::word(const std::vector<std::string>& words) const
{
    if (!m_json->is_string()) refuse("one of " + joinedWords(words));
    const std::string& text = m_json->get_ref<const std::string&>();
    if (std::find(words.begin(), words.end(), text) == words.end()) fail(unknownWord(text, words));
    return text;
}

Vector3 JsonValue::vector(const Limits& limits) const
{
    if (!m_json->is_array() || m_json->size() != 3) refuse("three numbers [x, y, z]");
    const std::vector<double> all = numbers(limits);
    return {all[0], all[1], all[2]};
}

Vector3 JsonValue::direction() const
{
    const Vector3 given = vector({-1e6, 1e6});
    const double size = length(given);
    if (!(size > 1e-6)) fail("the direction has no length");
    // A unit vector keeps its bits, so that a scene that was written is the same when it is read.
    return std::abs(size - 1) < 1e-12 ? given : normalized(given);
}

std::vector<double> JsonValue::numbers(const Limits& limits) const
{
    std::vector<double> all;
    each(0, [&](const JsonValue& item) { all.push_back(item.number(limits)); });
    return all;
}

void JsonValue::each(std::size_t least, const std::function<void(const JsonValue&)>& read) const
{
    if (!m_json->is_array() || m_json->size() < least)
        refuse(least > 0 ? "an array of " + std::to_string(least) + " or more" : "an array");
    for (std::size_t i = 0; i < m_json->size(); ++i)
        read(JsonValue((*m_json)[i], m_path + "/" + std::to_string(i)));
}

JsonObject::JsonObject(const JsonValue& value, std::vector<std::string> keys) : m_value(value)
{
    if (!value.json().is_object()) value.refuse("an object");
    for (const auto& item : value.json().items())
        if (std::find(keys.begin(), keys.end(), item.key()) == keys.end())
            throw SceneMistake(value.path() + "/" + item.key(), "unknown key: " + unknownWord(item.key(), keys));
}

JsonValue JsonObject::at(const char* key) const
{
    if (!has(key)) m_value.fail(std::string("the key '") + key + "' is missing");
    return JsonValue(m_value.json().at(key), m_value.path() + "/" + key);
}

void JsonObject::exclude(const char* one, const char* other, const char* reason) const
{
    if (has(one) && has(other))
        m_value.fail(std::string("'") + one + "' and '" + other + "' exclude each other: " + reason);
}

void JsonObject::read(const char* key, double& target, const Limits& limits) const
{
    if (has(key)) target = at(key).number(limits);
}

void JsonObject::read(const char* key, int& target, int least, int most) const
{
    if (has(key)) target = at(key).whole(least, most);
}

void JsonObject::read(const char* key, bool& target) const
{
    if (has(key)) target = at(key).truth();
}

void JsonObject::read(const char* key, std::string& target) const
{
    if (has(key)) target = at(key).text();
}

void JsonObject::read(const char* key, Vector3& target, const Limits& limits) const
{
    if (has(key)) target = at(key).vector(limits);
}

SceneJson parseJson(const std::string& text)
{
    std::vector<std::set<std::string>> keys;
    const auto note = [&keys](int, SceneJson::parse_event_t event, SceneJson& value)
    {
        if (event == SceneJson::parse_event_t::object_start) keys.emplace_back();
        if (event == SceneJson::parse_event_t::object_end) keys.pop_back();
        if (event == SceneJson::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
            throw SceneMistake("", "the key '" + value.get<std::string>() + "' is given twice in an object");
        return true;
    };
    try
    {
        return SceneJson::parse(text, note);
    }
    catch (const SceneJson::exception& exception)
    {
        throw SceneMistake("", plainText(exception.what()));
    }
}
}  // namespace drape
