// Places PoCL's threads on cores, for programs that have a machine to themselves.
#pragma once

namespace drape
{
// Tells PoCL to keep each of its threads on a core of its own (POCL_AFFINITY=1).
// Does nothing if that variable or one for their number is set, or if this process may not run on every core: a thread
// without a core ends the program. Call it before the first OpenCL call and before any thread starts.
//
// Reason: on a virtual machine Linux often wakes the threads on one core, one behind the other. A library must not
// decide this: a thread that must stay on its core waits there for other busy threads.
void keepPoclThreadsApart();
}  // namespace drape
