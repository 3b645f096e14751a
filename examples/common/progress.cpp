// A line on the terminal while something takes long.
#include "progress.hpp"

#include <cstdio>

#include <unistd.h>

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0)
{
}

Progress::~Progress()
{
    clear();
}

void Progress::show(const std::string &what)
{
    clear();
    what_ = what;
    start_ = last_ = std::chrono::steady_clock::now();
    print(0.0, 0.0);
}

void Progress::fraction(double done)
{
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(200))
        return;
    last_ = now;
    print(done, std::chrono::duration<double>(now - start_).count());
}

void Progress::clear()
{
    if (terminal_)
        std::fputs("\r\033[K", stderr);
}

void Progress::print(double done, double seconds)
{
    if (!terminal_)
        return;
    std::fprintf(stderr, "\r%s", what_.c_str());
    if (done > 0.0 && seconds > 1.0) {
        const int left = static_cast<int>(seconds * (1.0 - done) / done + 0.5);
        std::fprintf(stderr, " %3.0f %%, %d:%02d left", 100.0 * done, left / 60, left % 60);
    }
    std::fputs(" ...\033[K", stderr);
    std::fflush(stderr);
}
