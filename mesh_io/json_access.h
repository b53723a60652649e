// Access to JSON that may have any type anywhere: what is missing or of another type reads as absent.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

namespace drape
{
using Json = nlohmann::json;

// Returns the value of an object's key, or null.
inline const Json& at(const Json& object, const char* key)
{
    static const Json none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found == object.end() ? none : *found;
}

// Returns the item of a reference: an index into an array (glTF 2.0) or a name in an object (glTF 1.0). Returns null if
// there is none.
inline const Json& follow(const Json& items, const Json& reference)
{
    static const Json none;
    if (reference.is_string()) return at(items, reference.get_ref<const std::string&>().c_str());
    const bool there =
        items.is_array() && reference.is_number_unsigned() && reference.get<std::uint64_t>() < items.size();
    return there ? items[reference.get<std::size_t>()] : none;
}

// Reads a whole number from 0 to 2^53. `absent` where the key is missing. Returns false for anything else. JSON does
// not tell 3 from 3.0.
inline bool readCount(const Json& object, const char* key, std::size_t absent, std::size_t& count)
{
    const Json& value = at(object, key);
    count = absent;
    if (value.is_null()) return true;
    const double number = value.is_number() ? value.get<double>() : -1;
    if (!(number >= 0 && number <= 9007199254740992.0 && number == std::floor(number))) return false;
    count = static_cast<std::size_t>(number);
    return true;
}

// Reads an array of `count` numbers. Returns false, with `values` unchanged, for anything else.
inline bool readNumbers(const Json& array, std::size_t count, double* values)
{
    if (!array.is_array() || array.size() != count) return false;
    for (const Json& value : array)
        if (!value.is_number()) return false;
    for (std::size_t i = 0; i < count; ++i)
        values[i] = array[i].get<double>();
    return true;
}
}  // namespace drape
