// Lanes of a block of patches on a device, and the definitions with which kernels over patches are built.
#pragma once

#include <cstdint>
#include <string>

#include "bullet_plugin/core/device/device.h"

namespace drape
{
constexpr std::uint32_t kPatchWidthGpu = 32;  // a warp
constexpr std::uint32_t kPatchWidthCpu = 16;  // a vector of 512 bits

inline std::uint32_t patchWidth(const Device& device)
{
    return device.isGpu() ? kPatchWidthGpu : kPatchWidthCpu;
}

inline std::string patchDefines(const Device& device)
{
    // OpenCL does not bound the error of a native root; NVIDIA does (PTX: 2^-23 of it, over the whole range).
    const bool roots = device.isGpu() && device.info().m_platform.rfind("NVIDIA", 0) == 0;
    return "#define DRAPE_PATCH_WIDTH " + std::to_string(patchWidth(device)) + "\n#define DRAPE_LANES " +
           (device.isGpu() ? "1\n" : std::to_string(kPatchWidthCpu) + "\n") +
           (roots ? "#define DRAPE_NATIVE_ROOTS\n" : "");
}
}  // namespace drape
