// A step's unsorted contacts on a device, as the kernels that find them write them (kernels/lib/hit_list.h).
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "kernels/shared/contact.h"

namespace drape
{
struct HitBuffers
{
    Buffer<Contact>& m_hits;
    Buffer<cl_uint>& m_hitPlaces;  // has no memory where it is not needed, as m_slotSums
    Buffer<cl_uint>& m_slotCount;
    Buffer<cl_uint>& m_slotSums;
};
}  // namespace drape
