// Places arrays one behind the other in an arena of 32-bit words (kernels/shared/arenas.h), each aligned for vectors of
// four numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace drape
{
class WordOffsets
{
public:
    // Returns the offset of an array of `count` elements.
    template <class T>
    std::uint32_t add(std::size_t count)
    {
        constexpr std::size_t kAlignment = 4;
        static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
        const std::size_t first = m_words, words = count * sizeof(T) / sizeof(std::uint32_t);
        m_words += (words + kAlignment - 1) / kAlignment * kAlignment;
        return std::uint32_t(first);
    }
    std::size_t words() const { return m_words; }

private:
    std::size_t m_words = 0;
};

template <class Word, class T>
void copyToWords(Word* words, std::size_t offset, const T* source, std::size_t count)
{
    if (count > 0) std::memcpy(words + offset, source, count * sizeof(T));
}
}  // namespace drape
