// What a device of a CPU's kind builds its kernels with, for the host's: before any other header of theirs. Whatever
// they define is one file's alone then: linkers join inline functions of several files, and a machine may not have this
// one's instructions.
#pragma once

#define DRAPE_HOST_KERNELS
#define DRAPE_CPU
#define DRAPE_PATCH_WIDTH 16
#define DRAPE_LANES 16
