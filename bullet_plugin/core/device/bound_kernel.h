// A kernel whose launch takes the arguments of its bindings list (kernels/shared/bindings.h), checked by the compiler.
#pragma once

#include <type_traits>

#include "buffer_view.h"
#include "kernels/shared/bindings.h"
#include "program.h"

namespace drape
{
namespace bound
{
// The types of a list's arguments on the host.
template <typename Binding>
struct ArgumentOf;
template <typename T>
struct ArgumentOf<ValueBinding<T>>
{
    static_assert(std::is_trivially_copyable<T>::value && sizeof(T) % sizeof(cl_uint) == 0);
    using Type = const T&;
    static const T& passed(const T& value) { return value; }
};
template <typename T>
struct ArgumentOf<BufferBinding<T>>
{
    using Type = BufferView<T>;
    static const cl::Buffer& passed(const BufferView<T>& view) { return view.handle(); }
};
// The number of elements of local memory.
template <typename T>
struct ArgumentOf<LocalBinding<T>>
{
    using Type = std::size_t;
    static cl::LocalSpaceArg passed(std::size_t count) { return cl::Local(count * sizeof(T)); }
};
}  // namespace bound

template <typename Declared, typename List = typename Declared::List>
class BoundKernel;

// Declared: a type of kernels/<stage>/<stage>_bindings.h.
template <typename Declared, typename... Bindings>
class BoundKernel<Declared, BindingList<Bindings...>>
{
public:
    void create(Device& device, const cl::Program& program) { m_kernel.create(device, program, Declared::kName); }

    // Enqueues globalSize work-items, rounded up to groups of localSize; nothing for zero work-items.
    void launch(Device& device, std::size_t globalSize, std::size_t localSize,
                typename bound::ArgumentOf<Bindings>::Type... arguments)
    {
        m_kernel.launch(device, globalSize, localSize, bound::ArgumentOf<Bindings>::passed(arguments)...);
    }

private:
    Kernel m_kernel;
};
}  // namespace drape
