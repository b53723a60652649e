// Counts the fields of an aggregate at compile time, bases included as one each.
//
// The count is the largest number of initialisers that the aggregate accepts. Fields must not be arrays. Method:
// A. Polukhin, boost.pfr.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace drape
{
// Converts to the type of any field.
struct AnyField
{
    template <class Field>
    operator Field() const;
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
template <class Record, std::size_t... I>
auto acceptsFields(std::index_sequence<I...>, int) -> decltype(Record{(void(I), AnyField())...}, std::true_type());
template <class Record, std::size_t... I>
std::false_type acceptsFields(std::index_sequence<I...>, long);
#pragma GCC diagnostic pop

template <class Record, std::size_t Count>
constexpr bool kAcceptsFields = decltype(acceptsFields<Record>(std::make_index_sequence<Count>(), 0))::value;

template <class Record, std::size_t Count = 1>
constexpr std::size_t fieldCount()
{
    if constexpr (kAcceptsFields<Record, Count>)
        return fieldCount<Record, Count + 1>();
    else
        return Count - 1;
}
}  // namespace drape
