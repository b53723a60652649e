// The host's kernels of cloths with themselves for any CPU that the project is compiled for.
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAnyCpu
#include "self_kernel_set.h"
