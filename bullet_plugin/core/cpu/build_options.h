// Sets the build options of a CPU device for the host's kernels. Include it before any other kernel header. Every
// definition that follows belongs to one file alone: linkers merge inline functions of several files, and a machine
// may lack this file's instructions.
#pragma once

#define DRAPE_CPU_KERNELS
#define DRAPE_CPU
#define DRAPE_PATCH_WIDTH 16
#define DRAPE_LANES 16
