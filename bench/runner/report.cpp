// What a run of the benchmark found, as JSON and CSV.
#include "report.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <cjson/cJSON.h>

#include "command_line.hpp"
#include "error.hpp"

namespace fs = std::filesystem;

namespace
{

void write_file(const std::string &path, const std::string &text)
{
    const std::string aside = path + ".part";
    std::ofstream file(aside);
    file << text;
    file.close();
    std::error_code code;
    if (file)
        fs::rename(aside, path, code);
    if (!file || code)
        fail("%s: cannot be written", path.c_str());
}

void add_text(cJSON *object, const char *name, const std::string &text)
{
    if (text.empty())
        cJSON_AddNullToObject(object, name);
    else
        cJSON_AddStringToObject(object, name, text.c_str());
}

cJSON *to_json(const Figure &figure)
{
    cJSON *json = cJSON_CreateObject();
    add_text(json, "name", figure.name);
    add_text(json, "case", figure.case_name);
    if (figure.value && std::isfinite(*figure.value))
        cJSON_AddNumberToObject(json, "value", *figure.value);
    else
        cJSON_AddNullToObject(json, "value");
    add_text(json, "about", figure.about);
    return json;
}

cJSON *to_json(const Claim &claim)
{
    cJSON *json = cJSON_CreateObject();
    add_text(json, "id", claim.id);
    add_text(json, "claim", claim.claim);
    add_text(json, "measured", claim.measured);
    if (claim.reproduced)
        cJSON_AddBoolToObject(json, "reproduced", *claim.reproduced);
    else
        cJSON_AddNullToObject(json, "reproduced");
    add_text(json, "why", claim.why);
    return json;
}

} // namespace

Report::Report(std::string json_file, std::string csv_file)
    : json_file_(std::move(json_file)), csv_file_(std::move(csv_file))
{
    for (const std::string &file : {json_file_, csv_file_})
        if (!file.empty())
            check_writable(file);
}

void Report::write() const
{
    if (!json_file_.empty())
        write_file(json_file_, json());
    if (!csv_file_.empty())
        write_file(csv_file_, csv());
}

std::string Report::json() const
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "suite", suite.c_str());
    cJSON_AddBoolToObject(root, "quick", quick);
    cJSON_AddBoolToObject(root, "complete", complete);
    cJSON *list = cJSON_AddArrayToObject(root, "rows");
    for (const Row &row : rows)
        cJSON_AddItemToArray(list, cJSON_CreateRaw(::to_json(row).c_str()));
    list = cJSON_AddArrayToObject(root, "figures");
    for (const Figure &figure : figures)
        cJSON_AddItemToArray(list, to_json(figure));
    list = cJSON_AddArrayToObject(root, "claims");
    for (const Claim &claim : claims)
        cJSON_AddItemToArray(list, to_json(claim));
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    if (!text)
        fail("no memory for JSON");
    const std::string result = std::string(text) + "\n";
    cJSON_free(text);
    return result;
}

std::string Report::csv() const
{
    std::string text = csv_header();
    for (const Row &row : rows)
        text += to_csv(row);
    return text;
}
