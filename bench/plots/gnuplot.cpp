// Plots are scripts for gnuplot, which draws them.
#include "gnuplot.hpp"

#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "error.hpp"

namespace fs = std::filesystem;

namespace
{

struct Output {
    int status;
    std::string text;
};

Output shell(const std::string &command)
{
    Output output{-1, ""};
    std::FILE *pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe)
        return output;
    char part[1024];
    for (size_t n; (n = std::fread(part, 1, sizeof part, pipe)) > 0;)
        output.text.append(part, n);
    output.status = pclose(pipe);
    return output;
}

// As one word of the shell.
std::string word(const std::string &text)
{
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

// The line of gnuplot's output that tells what went wrong: those before it repeat the command.
std::string last_line(const std::string &text)
{
    const size_t end = text.find_last_not_of(" \n");
    if (end == std::string::npos)
        return "no message";
    const size_t begin = text.find_last_of('\n', end);
    return text.substr(begin + 1, end - begin);
}

// Names of cases may hold anything.
std::string file_name(std::string name)
{
    for (char &c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-')
            c = '_';
    return name;
}

} // namespace

void check_gnuplot()
{
    const Output output = shell("gnuplot -e 'set terminal'");
    if (output.status != 0)
        fail("--plots needs gnuplot, which does not run here: %s", last_line(output.text).c_str());
    for (const char *terminal : {" svg ", " pngcairo "})
        if (output.text.find(terminal) == std::string::npos)
            fail("--plots needs gnuplot with the terminal%sand this one is without", terminal);
}

void draw(const Plot &plot, const std::string &folder)
{
    const std::string name = file_name(plot.name), script = name + ".gp";
    const std::string path = (fs::path(folder) / script).string();
    std::ofstream file(path);
    file << "# Draws " << name << ".svg and " << name << ".png.\n"
         << "set encoding utf8\n"
         << plot.data << "do for [kind in \"svg png\"] {\n"
         << format(
                "if (kind eq \"svg\") { set terminal svg noenhanced size %d,%d font \"sans-serif,12\" background rgb "
                "\"white\" } else { set terminal pngcairo noenhanced size %d,%d font \"sans-serif,9\" }\n",
                plot.width, plot.height, plot.width, plot.height)
         // What the two draw at different sizes.
         << "small = kind eq \"svg\" ? \"10\" : \"7.5\"\npoint = kind eq \"svg\" ? 0.75 : 1.0\n"
         << "set output " << quoted(name + ".") << " . kind\n"
         << plot.body << "unset output\nreset\n}\n";
    file.close();
    if (!file)
        fail("%s: cannot be written", path.c_str());
    const Output output = shell("cd " + word(folder) + " && gnuplot " + word(script));
    if (output.status != 0)
        fail("gnuplot on %s: %s", path.c_str(), last_line(output.text).c_str());
}

std::string data_block(const std::string &name, const std::string &lines)
{
    return "$" + name + " << END\n" + lines + "END\n";
}

std::string quoted(const std::string &text)
{
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c == '\n' ? ' ' : c);
    return result + "\"";
}

std::string format(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}
