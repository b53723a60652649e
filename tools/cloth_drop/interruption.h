// Listens for signals that ask the program to end: SIGINT, SIGTERM and SIGHUP.
//
// While it listens, the first signal is only noted, so that a run can end after the current step and keep its results.
// The next signal has its earlier effect: it ends the program at once, or calls the handler that was installed before.
// An OpenCL driver's compiler, for example, has a handler that removes its files. Signals that are ignored when
// listening begins (nohup) remain ignored.
#pragma once

#include <string>

namespace drape
{
// Must not be called while listening.
void listenToSignals();
// Restores the earlier handlers. Received signals stay noted. Safe in a signal handler.
void stopListening();
// Returns the received signal in words, or "".
std::string interruption();
}  // namespace drape
