// Where PoCL's threads run, for programs that have a machine to themselves.
#pragma once

namespace drape
{
// Tells PoCL to keep each of its threads on a core of its own (POCL_AFFINITY=1), unless that variable or one
// for their number is set, or this process may not run on every core: a thread without a core ends the program. Before
// the first OpenCL call and any thread.
//
// Why: on a virtual machine Linux often wakes them on one core, one behind the other. For a library it is not to
// decide: a thread that must stay on its core waits there for whatever else is busy.
void keepPoclThreadsApart();
}  // namespace drape
