// Words of the bindings lists. A list names a kernel's arguments in order, each with its access, type and name. The
// kernel's signature comes from it in OpenCL C, and the host's typed launcher (core/device/bound_kernel.h) in C++.
//
// DRAPE_VALUE: a number, or a record of 32-bit numbers. DRAPE_READS: memory that nothing writes during the launch.
// DRAPE_WRITES: memory that the kernel reaches through this argument alone. DRAPE_UPDATES: memory that it reads and
// writes through several pointers, or that work-items share. DRAPE_LOCAL: local memory, sized by the launch.
#ifndef DRAPE_SHARED_BINDINGS_H
#define DRAPE_SHARED_BINDINGS_H

#include "types.h"

#ifdef __OPENCL_VERSION__
#define DRAPE_VALUE(type, name) const type name
#define DRAPE_READS(type, name) __global const type* restrict name
#define DRAPE_WRITES(type, name) __global type* restrict name
#define DRAPE_UPDATES(type, name) __global type* name
#define DRAPE_LOCAL(type, name) __local type* name
#else
#define DRAPE_VALUE(type, name) ::drape::ValueBinding<type>
#define DRAPE_READS(type, name) ::drape::BufferBinding<type>
#define DRAPE_WRITES(type, name) ::drape::BufferBinding<type>
#define DRAPE_UPDATES(type, name) ::drape::BufferBinding<type>
#define DRAPE_LOCAL(type, name) ::drape::LocalBinding<type>

// Declares a kernel for the host: a type of the kernel's name, with its list of arguments.
#define DRAPE_BIND(kernel, ...)                         \
    struct kernel                                       \
    {                                                   \
        static constexpr const char* kName = #kernel;   \
        using List = ::drape::BindingList<__VA_ARGS__>; \
    };

namespace drape
{
template <typename T>
struct ValueBinding
{
};
template <typename T>
struct BufferBinding
{
};
template <typename T>
struct LocalBinding
{
};
template <typename... Bindings>
struct BindingList
{
};
}  // namespace drape
#endif

#endif
