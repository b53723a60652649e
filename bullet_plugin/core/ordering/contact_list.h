// Contacts in memory that a back end owns.
#pragma once

#include <cstddef>

#include "kernels/shared/contact.h"

namespace drape
{
struct ContactList
{
    const Contact* m_first = nullptr;
    std::size_t m_count = 0;

    const Contact* begin() const { return m_first; }
    const Contact* end() const { return m_first + m_count; }
    std::size_t size() const { return m_count; }
    const Contact& operator[](std::size_t i) const { return m_first[i]; }
};
}  // namespace drape
