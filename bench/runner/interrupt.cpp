// Ctrl-C during a long run.
#include "interrupt.hpp"

#include <csignal>

namespace
{

volatile std::sig_atomic_t interrupted = 0;

extern "C" void on_signal(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

void catch_interrupts()
{
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

void check_interrupted()
{
    if (interrupted)
        throw Interrupted();
}
