// What a run of the benchmark found: rows, figures made of several rows, and the papers' claims; as JSON and CSV.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "row.hpp"

// A figure that is not one row's: a growth exponent, a ratio of two rows.
struct Figure {
    std::string name, case_name;
    std::optional<double> value; // none: could not be measured
    std::string about;           // what it is made of, or why there is none
};

// A claim of one of the papers, held against this run.
struct Claim {
    std::string id;       // as in the list of claims, "S1"
    std::string claim;    // in words
    std::string measured; // in words, empty if nothing was
    std::optional<bool> reproduced;
    std::string why; // where it was not reproduced or not measured
};

class Report
{
  public:
    // Files that are empty are not written. The rest must be writable: throws Error now rather than after the run.
    Report(std::string json_file, std::string csv_file);

    std::string suite;
    bool quick = false;
    bool complete = false;
    std::vector<Row> rows;
    std::vector<Figure> figures;
    std::vector<Claim> claims;

    // Writes everything so far, aside and renamed, so that there is always a whole file. Throws Error.
    void write() const;

  private:
    std::string json() const;
    std::string csv() const;

    std::string json_file_, csv_file_;
};
