// The host's kernels of cloths with themselves for CPUs with AVX-512; CMakeLists.txt has this file compiled for
// these.
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAvx512
#include "self_kernel_set.h"
