// Runs Bullet's own collision in a child process, since it can stall for minutes in one step, and collects what it
// measured until it ended, or the cap or a signal (interruption.h) ended it.
//
// The child is this program with --backend bullet and a hidden option; it writes a line before and after every step to
// its standard output. The cap counts stepping, and measuring where it says so. The child is always gone when the
// functions return.
#pragma once

#include <string>

#include "tools/cloth_drop/capped_child.h"
#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/run_plan.h"
#include "tools/cloth_drop/run_record.h"

namespace drape
{
// Runs in the parent. Returns false with one line in `error` if the child could not be started or failed.
bool runBuiltInChild(const Options& options, BulletMode mode, const ChildCap& cap, const RunPlan& plan,
                     RunRecord& record, std::string& error);

// Runs in the child and streams its steps. Does not return, since Bullet's own clean-up could take minutes.
[[noreturn]] void streamBuiltIn(const Options& options, const RunPlan& plan);
}  // namespace drape
