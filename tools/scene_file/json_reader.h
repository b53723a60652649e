// Reading of JSON with mistakes that a user can mend: each names the path of the value (/cloths/0/material) and what
// was expected there.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/vector3.h"

namespace drape
{
using SceneJson = nlohmann::ordered_json;

// A mistake in a document; what() is "PATH: what was expected", with / for the whole document.
class SceneMistake : public std::runtime_error
{
public:
    SceneMistake(const std::string& path, const std::string& text);
};

// Limits of a number, both included.
struct Limits
{
    double m_least, m_most;
};

// A value of a document and its path. Refers to the document. All functions that read throw SceneMistake.
class JsonValue
{
public:
    JsonValue(const SceneJson& json, std::string path) : m_json(&json), m_path(std::move(path)) {}

    const SceneJson& json() const { return *m_json; }
    const std::string& path() const { return m_path; }
    // Throws "expected ..., found ...".
    [[noreturn]] void refuse(const std::string& expected) const;
    // Throws another text.
    [[noreturn]] void fail(const std::string& text) const { throw SceneMistake(m_path, text); }

    double number(const Limits& limits) const;
    int whole(int least, int most) const;
    bool truth() const;
    // A text that is not empty.
    std::string text() const;
    // One of the words; suggests a similar one.
    std::string word(const std::vector<std::string>& words) const;
    Vector3 vector(const Limits& limits) const;
    // A vector that is not 0, at length 1.
    Vector3 direction() const;
    std::vector<double> numbers(const Limits& limits) const;
    // Calls `read` with each item of an array of `least` items at least.
    void each(std::size_t least, const std::function<void(const JsonValue&)>& read) const;

private:
    const SceneJson* m_json;
    std::string m_path;
};

// An object with known keys. Its constructor throws for another type and for an unknown key, with a suggestion.
class JsonObject
{
public:
    JsonObject(const JsonValue& value, std::vector<std::string> keys);

    const JsonValue& value() const { return m_value; }
    bool has(const char* key) const { return m_value.json().contains(key); }
    // Throws if the key is missing.
    JsonValue at(const char* key) const;
    // Throws if both keys are there.
    void exclude(const char* one, const char* other, const char* reason) const;

    // These leave `target` unchanged where the key is missing.
    void read(const char* key, double& target, const Limits& limits) const;
    void read(const char* key, int& target, int least, int most) const;
    void read(const char* key, bool& target) const;
    void read(const char* key, std::string& target) const;
    void read(const char* key, Vector3& target, const Limits& limits) const;

private:
    JsonValue m_value;
};

// Parses a text. Throws SceneMistake for what is no JSON, with line and column, and for a key that is given twice.
SceneJson parseJson(const std::string& text);
}  // namespace drape
