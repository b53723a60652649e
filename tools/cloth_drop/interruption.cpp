#include "tools/cloth_drop/interruption.h"

#include <csignal>
#include <cstring>

namespace drape
{
namespace
{
struct Listened
{
    int m_number;
    struct sigaction m_before;
};

// A handler gets no data of its program, so its data is here: the replaced handler, and the received signal or 0.
Listened listened[] = {{SIGINT, {}}, {SIGTERM, {}}, {SIGHUP, {}}};
volatile std::sig_atomic_t noted = 0;

void note(int number)
{
    noted = number;
    stopListening();
}
}  // namespace

void listenToSignals()
{
    for (Listened& signal : listened)
    {
        if (::sigaction(signal.m_number, nullptr, &signal.m_before) != 0 || signal.m_before.sa_handler == SIG_IGN)
            continue;
        struct sigaction action = {};
        action.sa_handler = note;
        action.sa_flags = SA_RESTART;  // interrupted writes continue
        ::sigaction(signal.m_number, &action, nullptr);
    }
}

void stopListening()
{
    for (const Listened& signal : listened)
    {
        struct sigaction now = {};
        if (::sigaction(signal.m_number, nullptr, &now) == 0 && now.sa_handler == note)
            ::sigaction(signal.m_number, &signal.m_before, nullptr);
    }
}

std::string interruption()
{
    return noted == 0 ? "" : std::string("ended by a signal: ") + ::strsignal(noted);
}
}  // namespace drape
