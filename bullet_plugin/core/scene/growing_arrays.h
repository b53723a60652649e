// Helps arrays that grow and shrink from step to step to keep a suitable capacity.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace drape
{
// Reserves capacity for that many elements and, if it has to grow, a quarter more, so that elements are seldom copied.
// On a system that allocates pages on first write, unused capacity takes no memory.
template <typename T>
void reserveGrowing(std::vector<T>& elements, std::size_t count)
{
    if (count > elements.capacity()) elements.reserve(count + count / 4);
}

// Resizes to that many elements, with spare capacity.
template <typename T>
void resizeGrowing(std::vector<T>& elements, std::size_t count)
{
    reserveGrowing(elements, count);
    elements.resize(count);
}

// Releases unused capacity if it is more than three quarters.
template <typename T>
void shrinkSparse(std::vector<T>& elements)
{
    if (elements.capacity() / 4 > elements.size()) elements.shrink_to_fit();
}

// Calls fill() to fill the list; fill() returns the number of all elements. Repeats with a longer list if they did not
// fit, unless they exceed the limit. The list must not be empty. Returns how often it grew.
template <typename T, typename Fill>
std::size_t fillGrowing(std::vector<T>& list, std::size_t limit, const Fill& fill)
{
    for (std::size_t retries = 0;; ++retries)
    {
        const std::size_t wanted = fill();
        if (wanted <= list.size() || wanted > limit) return retries;
        list = std::vector<T>();  // frees the old memory first, so that only one exists at a time
        list.resize(std::min(wanted + wanted / 4, limit));
    }
}
}  // namespace drape
