// A line on the terminal while something takes long; gone when it is done. Nothing in files and pipes.
#pragma once

#include <chrono>
#include <string>

class Progress
{
  public:
    Progress();
    ~Progress();
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    // Starts a new line.
    void show(const std::string &what);
    // How much of it is done, 0 to 1; after a second with the time that is left.
    void fraction(double done);
    void clear();

  private:
    void print(double done, double seconds);

    const bool terminal_;
    std::string what_;
    std::chrono::steady_clock::time_point start_{}, last_{};
};
