// Room in arrays that grow as meshes come.
#pragma once

#include <cstddef>
#include <vector>

namespace drape
{
// Room for that many elements and, where there was not, a quarter more: so what is there is copied seldom. On a system
// that gives pages as they are written, room that is not used takes no memory.
template <typename T>
void reserveRoom(std::vector<T>& elements, std::size_t count)
{
    if (count > elements.capacity()) elements.reserve(count + count / 4);
}

// That many elements, with such room.
template <typename T>
void resizeWithRoom(std::vector<T>& elements, std::size_t count)
{
    reserveRoom(elements, count);
    elements.resize(count);
}
}  // namespace drape
