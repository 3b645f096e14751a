// Parts of command lines that the tools share. Errors exit with status 2 and one line on standard error.
#pragma once

#include <cstdint>
#include <string>

class CommandLine
{
  public:
    // `program` starts every message.
    explicit CommandLine(const char *program) : program_(program)
    {
    }
    [[noreturn]] void error(const std::string &text) const;
    // A whole number from `least` to `most`, a number from `least` to `most`, and WIDTHxHEIGHT.
    uint32_t whole(const char *option, const char *text, uint32_t least, uint32_t most) const;
    double real(const char *option, const char *text, double least, double most) const;
    void size(const char *option, const char *text, uint32_t &width, uint32_t &height) const;

  private:
    const char *program_;
};

bool has_extension(const std::string &path, const char *extension);

// Before a long run: that `path` can be written, without touching what is there. Throws Error.
void check_writable(const std::string &path);
// Likewise for a folder, which is created if needed, and a file in it.
void check_writable_folder(const std::string &path, const std::string &file);
