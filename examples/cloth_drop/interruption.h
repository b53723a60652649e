// Signals that ask the program to end: SIGINT, SIGTERM and SIGHUP. While it listens the first of them is only noted, so
// that a run may end after the step under way and keep what it has; the next one does what it did before: it ends the
// program at once, unless somebody else has a handler (an OpenCL driver's compiler removes its files). Signals that are
// ignored when listening begins (nohup) stay so.
#pragma once

#include <string>

namespace drape
{
// Not while it listens already.
void listenToSignals();
// Back to what was before. What has come stays noted. Safe in a signal handler.
void stopListening();
// "" or what came, in words.
std::string interruption();
}  // namespace drape
