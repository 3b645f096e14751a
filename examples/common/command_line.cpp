// Parts of command lines that the tools share.
#include "command_line.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "error.hpp"
#include "image_io.hpp"

namespace fs = std::filesystem;

namespace
{

// A whole number at the start of `text`, which then points behind it. False if there is none, or it is too large.
bool take_number(const char *&text, uint32_t &value)
{
    if (*text < '0' || *text > '9')
        return false;
    char *end = nullptr;
    const unsigned long long parsed = std::strtoull(text, &end, 10);
    text = end;
    value = static_cast<uint32_t>(parsed);
    return parsed <= UINT32_MAX;
}

} // namespace

void CommandLine::error(const std::string &text) const
{
    std::fprintf(stderr, "%s: %s; see --help\n", program_, text.c_str());
    std::exit(2);
}

uint32_t CommandLine::whole(const char *option, const char *text, uint32_t least, uint32_t most) const
{
    const char *end = text;
    uint32_t value = 0;
    if (!take_number(end, value) || *end != '\0' || value < least || value > most)
        error(std::string(option) + " is \"" + text + "\", expected a whole number from " + std::to_string(least) +
              " to " + std::to_string(most));
    return value;
}

double CommandLine::real(const char *option, const char *text, double least, double most) const
{
    char *end = nullptr;
    const double value = std::strtod(text, &end);
    char range[64];
    std::snprintf(range, sizeof range, "%g to %g", least, most);
    if (end == text || *end != '\0' || !(value >= least && value <= most))
        error(std::string(option) + " is \"" + text + "\", expected a number from " + range);
    return value;
}

void CommandLine::size(const char *option, const char *text, uint32_t &width, uint32_t &height) const
{
    const char *end = text;
    const bool ok = take_number(end, width) && *end++ == 'x' && take_number(end, height) && *end == '\0';
    if (!ok || width - 1u >= max_image_size || height - 1u >= max_image_size)
        error(std::string(option) + " is \"" + text + "\", expected WIDTHxHEIGHT, each from 1 to " +
              std::to_string(max_image_size));
}

bool has_extension(const std::string &path, const char *extension)
{
    std::string end = fs::path(path).extension().string();
    std::transform(end.begin(), end.end(), end.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    return end == extension;
}

void check_writable(const std::string &path)
{
    std::error_code code;
    const bool existed = fs::exists(path, code);
    std::FILE *file = fs::is_directory(path, code) ? nullptr : std::fopen(path.c_str(), "ab");
    if (!file)
        fail("%s: cannot be written: %s", path.c_str(), std::strerror(fs::is_directory(path, code) ? EISDIR : errno));
    std::fclose(file);
    if (!existed)
        fs::remove(path, code);
}

void check_writable_folder(const std::string &path, const std::string &file)
{
    std::error_code code;
    fs::create_directories(path, code);
    if (!fs::is_directory(path))
        fail("%s: cannot create this folder: %s", path.c_str(),
             code ? code.message().c_str() : "there is a file of that name");
    check_writable((fs::path(path) / file).string());
}
