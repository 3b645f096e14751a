// The one exception type of the examples: a single line for a person, naming the file or the setting and what was
// expected. main() catches it and prints it.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <stdexcept>

struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn, gnu::format(printf, 1, 2)]] inline void fail(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    throw Error(text);
}
