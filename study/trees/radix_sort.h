// A stable sort of numbers by 32-bit keys on a device: three launches per eight bits of the keys that count.
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "study/methods.h"

namespace drape
{
// Returns whether a stage runs its kernels for groups, not its serial ones, on this device.
bool runsGroups(const Device& device, WorkShape shape);

class RadixSortStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Sorts count keys and moves numbers along; bits: how many low bits of the keys may be set. Returns after
    // enqueueing.
    void enqueue(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count, cl_uint bits,
                 WorkShape shape);
    // out[i] = values[numbers[i]]. Returns after enqueueing.
    void gather(Device& device, Buffer<cl_uint>& values, Buffer<cl_uint>& numbers, cl_uint count, Buffer<cl_uint>& out);

private:
    void passInTiles(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count, cl_uint shift);
    void passInStretches(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count, cl_uint shift);

    Kernel m_countTiles, m_countStretches, m_scan, m_scanSerial, m_scatterTiles, m_scatterStretches, m_gather;
    Buffer<cl_uint> m_counts{"sorting"}, m_totals{"sorting"}, m_otherKeys{"sorting"}, m_otherNumbers{"sorting"};
};
}  // namespace drape
