// The host's kernels for any CPU that the project is compiled for.
#define DRAPE_KERNEL_SET kernelsOfAnyCpu
#define DRAPE_SELF_KERNEL_SET selfKernelsOfAnyCpu
#define DRAPE_INSTRUCTIONS "any CPU"
#include "kernel_set.h"
