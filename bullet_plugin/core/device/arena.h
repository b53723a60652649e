// One device allocation that holds several arrays: a kernel takes them as one argument, and finds each at its position
// (kernels/shared/arenas.h).
//
// Arrays keep their order. A demand for more room moves all of them to a larger allocation; elements that the demand
// keeps are copied. Each array has a name of its own in the memory ledger. Cost of a move: a copy of what is kept, and
// both allocations until it ends. Does not outlive its device.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "device.h"

namespace drape
{
// The allocation and its arrays, by index.
class ArenaMemory
{
public:
    ArenaMemory() = default;
    ArenaMemory(const ArenaMemory&) = delete;
    ArenaMemory& operator=(const ArenaMemory&) = delete;

    std::size_t add(std::string name, std::size_t elementBytes);
    // Demands room for `count` elements at the next make(), which keeps the first `kept` of them.
    void demand(std::size_t array, std::size_t count, std::size_t kept);
    // Makes room for all demands. Arrays without a demand keep their room and their elements. If kept elements move, up
    // to a quarter of spare room is added to the array that grew.
    void make(Device& device);
    void release();

    std::size_t capacity(std::size_t array) const { return m_arrays[array].m_capacity; }
    // Returns the array's position in words of 32 bits.
    cl_uint word(std::size_t array) const { return cl_uint(m_arrays[array].m_first / sizeof(cl_uint)); }

    // Enqueue a copy; the host memory must stay unchanged until a wait for the device.
    void write(Device& device, std::size_t array, const void* source, std::size_t count, std::size_t offset);
    void read(Device& device, std::size_t array, void* target, std::size_t count, std::size_t offset);
    // Enqueues a copy of the first elements of another arena's array, of elements of the same size.
    void copy(Device& device, std::size_t array, const ArenaMemory& from, std::size_t fromArray, std::size_t count);

    cl::Buffer& handle() { return m_buffer; }
    const cl::Buffer& handle() const { return m_buffer; }
    // Returns the size of the allocation.
    std::size_t bytes() const { return m_bytes; }

private:
    struct Array
    {
        std::string m_name;
        std::size_t m_elementBytes;
        std::size_t m_first = 0;     // bytes
        std::size_t m_capacity = 0;  // elements
        std::size_t m_wanted = 0, m_kept = 0;
        bool m_demanded = false;
        std::shared_ptr<const void> m_entry;
    };

    bool fits() const;
    // Places the arrays; spare: with spare room for those that grow. Returns the bytes of all.
    std::size_t place(std::vector<Array>& arrays, bool spare) const;

    std::vector<Array> m_arrays;
    cl::Buffer m_buffer;
    std::size_t m_bytes = 0;
};

// An arena whose word type tells it from others.
template <typename Word>
class Arena : public ArenaMemory
{
public:
    Arena() { static_assert(sizeof(Word) == sizeof(cl_uint) && std::is_trivially_copyable<Word>::value); }
};

// An array of T in an arena, which must stay where it is. Element counts, not bytes.
template <typename T>
class ArenaArray
{
public:
    template <typename Word>
    ArenaArray(Arena<Word>& arena, std::string name) : m_arena(&arena), m_index(arena.add(std::move(name), sizeof(T)))
    {
        static_assert(sizeof(T) % sizeof(Word) == 0);
    }

    void demand(std::size_t count, std::size_t kept = 0) { m_arena->demand(m_index, count, kept); }
    std::size_t capacity() const { return m_arena->capacity(m_index); }
    cl_uint word() const { return m_arena->word(m_index); }
    void write(Device& device, const T* source, std::size_t count, std::size_t offset = 0)
    {
        m_arena->write(device, m_index, source, count, offset);
    }
    // Writes the elements from `first` on.
    void append(Device& device, const std::vector<T>& source, std::size_t first = 0)
    {
        write(device, source.data() + first, source.size() - first, first);
    }
    void read(Device& device, T* target, std::size_t count, std::size_t offset = 0) const
    {
        m_arena->read(device, m_index, target, count, offset);
    }
    void copy(Device& device, const ArenaArray& from, std::size_t count)
    {
        m_arena->copy(device, m_index, *from.m_arena, from.m_index, count);
    }

private:
    ArenaMemory* m_arena;
    std::size_t m_index;
};
}  // namespace drape
