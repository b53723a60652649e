// Blocks signals for the calling thread while this lives, and for threads that it starts meanwhile: signal handlers
// belong to the application and run on its own threads.
#pragma once

#include <csignal>

#include <pthread.h>

namespace drape
{
class BlockedSignals
{
public:
    BlockedSignals()
    {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &m_before);
    }
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &m_before, nullptr); }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

private:
    sigset_t m_before;
};
}  // namespace drape
