// SPDX-License-Identifier: Apache-2.0
// The forms of a report: JSON, CSV, tables, pictures, and `relief-accuracy report`.
#include "accuracy_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "tools/report_sample.h"
#include "tools/schema_page.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::sample_report;
using test::Workplace;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

TEST(AccuracyJson, MatchesItsDocument) {
    const std::vector<test::SchemaRow> rows = test::schema_rows("## accuracy.json");
    ASSERT_GT(rows.size(), 50U);
    EXPECT_THAT(test::schema_faults(json_of(sample_report(), true), rows, true), IsEmpty());
    // The check finds missing, new and wrong values.
    json broken = json_of(sample_report(), true);
    broken["machine"]["host"] = "somewhere";
    broken["settings"]["quick"] = 1;
    broken["experiments"][0].erase("truth");
    EXPECT_THAT(test::schema_faults(broken, rows, false),
                testing::UnorderedElementsAre("machine.host: is not documented",
                                              "settings.quick: is a number, not boolean",
                                              "experiments[].truth: is missing"));
}

TEST(AccuracyJson, ReadsBackAsTheSame) {
    const Workplace workplace;
    const AccuracyReport report = sample_report();
    write_report(workplace / "out", report);
    const AccuracyReport again = read_report(workplace / "out/accuracy.json");
    // The pixels of pictures are not read.
    EXPECT_EQ(json_of(again, true).dump(), json_of(report, true).dump());
    EXPECT_EQ(again.machine, report.machine);
    EXPECT_EQ(again.settings.other_programs, report.settings.other_programs);
    const Experiment& was = report.experiments[0];
    const Experiment& is = again.experiments[0];
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(is.measurements[i].error, was.measurements[i].error);
        EXPECT_EQ(is.measurements[i].cost, was.measurements[i].cost);
    }
    EXPECT_EQ(is.reference_error, 0.6);
    EXPECT_EQ(is.reference_error_upper, 6.0);
    EXPECT_NEAR(is.measurements[1].expected.value().total(), 0.65, 1e-12);
    EXPECT_THAT(is.input_findings, SizeIs(1));
    EXPECT_TRUE(std::isnan(is.charts[0].curves[0].points[0].error));
    EXPECT_EQ(is.charts[0].curves[0].points[1].x, 0.001);
}

TEST(AccuracyPage, StatesThatTheMachineWasBusy) {
    const Workplace workplace;
    AccuracyReport report = sample_report();
    write_report(workplace / "out", report);
    EXPECT_THAT(workplace.read("out/report.html"),
                HasSubstr("used 1.7 of 2 processors: the machine was busy"));
    report.settings.other_programs = OtherPrograms{0.02, 2};
    write_report(workplace / "out", report);
    EXPECT_THAT(workplace.read("out/report.html"), HasSubstr("used 0.02 of 2 processors<"));
}

TEST(ProcessorUse, ExcludesTheTimeOfThisProcess) {
    using Clock = std::chrono::steady_clock;
    constexpr double tolerance = 0.3;  // /proc/stat counts in hundredths of a second.
    const ProcessorUse use;
    const Clock::time_point begin = Clock::now();
    const std::clock_t own_begin = std::clock();
    while (Clock::now() - begin < std::chrono::milliseconds(300)) {
    }
    const std::optional<OtherPrograms> others = use.of_others();
    const double own = static_cast<double>(std::clock() - own_begin) / CLOCKS_PER_SEC;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (!others) GTEST_SKIP() << "the system does not state it";
    EXPECT_GE(others->processors, 0.0);
    EXPECT_LE(others->processors, others->available - own / seconds + tolerance);
}

/// A broken report with its error message.
struct Broken {
    const char* pointer;
    json value;  ///< Discarded: erased.
    const char* error;
};

TEST(BrokenReport, IsRefusedWithAPointer) {
    const json gone = json(json::value_t::discarded);
    const std::vector<Broken> rows = {
        {"/format", "glTF", "/format: is 'glTF', not 'relief-accuracy'"},
        {"/format", gone, "/format: is missing"},
        {"/version", 2,
         "/version: is 2, but only 1 can be read (create the report again with this "
         "relief-accuracy, or use the version that created it)"},
        {"/version", "1", "/version: must be an integer of at least 0"},
        {"/experiments", 5, "/experiments: is of type number, not array"},
        {"/experiments/0/id", gone, "/experiments/0/id: is missing"},
        {"/experiments/0/subject", "colour",
         "subject 'colour' is not one of normals, tangents, bump, storage, compression, bake, "
         "decimation, unwrapping, relief, shading, stability"},
        {"/experiments/0/measurements/1/method", "exact, slow",
         "/experiments/0/measurements/1: repeats method 'exact, slow'"},
        {"/experiments/0/measurements/1/error/rms", "much",
         "/experiments/0/measurements/1/error/rms: is of type string, not number"},
        {"/experiments/0/measurements/1/error/count", -1,
         "/experiments/0/measurements/1/error/count: must be an integer of at least 0"},
        {"/experiments/0/measurements/1/cost/one_thread/rounds/2", -1e-3,
         "/experiments/0/measurements/1/cost/one_thread/rounds/2: must be above 0 seconds"},
        {"/experiments/0/charts/0/curves/0/points/1", json::array({1}),
         "/experiments/0/charts/0/curves/0/points/1: has 1 numbers, not 2"},
        {"/machine", nullptr, "/machine: is of type null, not object"}};
    const Workplace workplace;
    for (const Broken& row : rows) {
        SCOPED_TRACE(row.error);
        json report = json_of(sample_report(), true);
        const json::json_pointer place(row.pointer);
        if (row.value.is_discarded())
            report.at(place.parent_pointer()).erase(place.back());
        else
            report[place] = row.value;
        workplace.write("report.json", report.dump());
        try {
            read_report(workplace / "report.json");
            ADD_FAILURE() << "was read";
        } catch (const FileError& error) {
            EXPECT_EQ(error.what(), (workplace / "report.json").string() + ": " + row.error);
        }
    }
}

TEST(AccuracyCsv, HasARowForEachMeasurementAndQuotesCommas) {
    EXPECT_EQ(measurements_csv(sample_report()),
              "experiment,subject,method,choices,error_unit,count,undefined,rms,mean,p99,max,psnr,"
              "item,items,one_thread_seconds,one_thread_p10,one_thread_p90,one_thread_rounds,"
              "all_threads_seconds,all_threads_p10,all_threads_p90,all_threads_rounds,peak_bytes,"
              "stored_bytes,efficient\n"
              "storage/sample,storage,\"exact, slow\",\"code=exact, slow\",degrees,10,0,0,0,0,0,,"
              "frame,10,0.001,0.00092,0.00108,3,0.0005,0.0005,0.0005,3,4096,2.5,1\n"
              "storage/sample,storage,near,code=near,degrees,10,2,0.25,0.125,0.5,0.75,40,"
              "frame,10,0.0005,0.00046,0.00054,3,0.00025,0.00025,0.00025,3,4096,2.5,0\n");
    EXPECT_EQ(curves_csv(sample_report()),
              "experiment,chart,method,x_label,x,error_unit,error\n"
              "storage/sample,scale,near,scale,1e-06,degrees,\n"
              "storage/sample,scale,near,scale,0.001,degrees,0.5\n"
              "storage/sample,scale,near,scale,1,degrees,0.25\n");
}

TEST(AccuracyTable, MarksTheFrontierAndAlignsItsColumns) {
    const std::string table = table_of(sample_report().experiments[0]);
    EXPECT_THAT(
        table,
        HasSubstr(
            "  expected: RMS, the root of the sum of squares of the reference error, 0.6 to 6 (the "
            "input does not show it), and the error of the method\n"
            "                   RMS   mean   99 %    max  PSNR, dB  undefined    expected         "
            "       one thread          all threads  memory  stored\n"
            "  * exact, slow      0      0      0      0         –          0     0.600–6  1.00 ms "
            "(920 µs–1.08 ms)  500 µs (500–500 µs)  4.1 kB  2.50 B\n"
            "    near         0.250  0.125  0.500  0.750        40   2 (17 %)  0.650–6.01       "
            "500 µs (460–540 µs)  250 µs (250–250 µs)  4.1 kB  2.50 B\n"
            "  near: It is not far.\n"));
    EXPECT_THAT(table,
                HasSubstr("    near: – at 1e-06, 0.250 at 1, order -0.10 (in theory 0), breaks "
                          "at 1e-06\n"));
    Experiment untimed = sample_report().experiments[0];
    for (Measurement& one : untimed.measurements)
        one.cost = {};
    EXPECT_THAT(table_of(untimed), Not(HasSubstr("thread")));
}

TEST(AccuracyTable, ChoosesUnitsOfTimes) {
    EXPECT_EQ(format_seconds(8.4e-8), "84.0 ns");
    EXPECT_EQ(format_seconds(4.126e-6), "4.13 µs");
    EXPECT_EQ(format_seconds(9.996e-4), "1.00 ms");
    EXPECT_EQ(format_seconds(0.0123), "12.3 ms");
    EXPECT_EQ(format_seconds(123.4), "123 s");
    EXPECT_EQ(format_seconds(0.0), "0.00 ns");
}

TEST(AccuracyFiles, PicturesHaveThePathsOfTheJson) {
    const Workplace workplace;
    write_report(workplace / "out", sample_report());
    EXPECT_EQ(workplace.outputs(),
              "accuracy-curves.csv accuracy.csv accuracy.json pictures report.html");
    const json one = json::parse(workplace.read("out/accuracy.json"))["experiments"][0];
    EXPECT_EQ(one["heat_maps"][0]["file"], "pictures/storage-sample-heat-1.png");
    for (const json& file :
         {one["heat_maps"][0]["file"], one["pictures"][0]["before"], one["pictures"][0]["after"]}) {
        const Image image =
            read_image(workplace / "out" / file.get<std::string>(), ImageUse::color);
        EXPECT_EQ(image.width, 2);
        EXPECT_EQ(image.height, 1);
    }
    // An error of 0 is black, and the largest error is bright.
    const Image heat =
        read_image(workplace / "out/pictures/storage-sample-heat-1.png", ImageUse::color);
    EXPECT_EQ(heat.as<std::uint8_t>()[0], 0);
    EXPECT_GT(heat.as<std::uint8_t>()[3], 200);
}

TEST(ThisMachine, IsKnown) {
    const Machine machine = this_machine(false);
    EXPECT_GE(machine.cores, 1U);
    EXPECT_GT(machine.memory_bytes, std::uint64_t{1} << 28);
    EXPECT_THAT(machine.system, HasSubstr("Linux"));
    EXPECT_THAT(machine.compiler, testing::MatchesRegex("(GCC|Clang) [0-9].*"));
    EXPECT_FALSE(machine.opengl);
    EXPECT_EQ(difference_of(machine, machine), "");
    Machine other = machine;
    other.build = "Debug";
    EXPECT_TRUE(may_compare_times(machine, other)) << "the build is what is compared";
    EXPECT_EQ(difference_of(machine, other), "build: " + machine.build + ", then Debug");
    other.cores += 1;
    EXPECT_FALSE(may_compare_times(machine, other));
}

TEST(AccuracyReportCommand, MakesThePageThatTheRunMade) {
    const Workplace workplace;
    write_report(workplace / "made", sample_report());
    const std::string first = workplace.read("made/report.html");
    std::filesystem::remove(workplace / "made/report.html");
    const ProgramResult result = workplace.run("relief-accuracy report made/accuracy.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("made/report.html: "));
    EXPECT_EQ(workplace.read("made/report.html"), first);
    const ProgramResult elsewhere =
        workplace.run("relief-accuracy report made/accuracy.json --output page.html --quiet");
    EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.error;
    EXPECT_EQ(elsewhere.out, "");
    EXPECT_EQ(workplace.read("page.html"), first);
}

TEST(AccuracyReportCommand, ReportsMissingPictures) {
    const Workplace workplace;
    workplace.write("printed.json", json_of(sample_report(), false).dump());
    const ProgramResult result = workplace.run("relief-accuracy report printed.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const std::string page = workplace.read("report.html");
    EXPECT_THAT(page, HasSubstr("<p class=\"absent\">Where, near: black is 0, the brightest "));
    EXPECT_THAT(page, HasSubstr("<p class=\"absent\">Seen: truth: no picture was written</p>"));
    EXPECT_THAT(page, Not(HasSubstr("data:image/png")));
}

TEST(AccuracyReportCommand, LeavesFilesOutsideTheFolderAlone) {
    const Workplace workplace;
    write_report(workplace / "made", sample_report());
    json report = json::parse(workplace.read("made/accuracy.json"));
    for (const char* file : {"../secret.png", "/etc/passwd", "pictures/../../secret.png"}) {
        report["experiments"][0]["heat_maps"][0]["file"] = file;
        workplace.write("made/accuracy.json", report.dump());
        const ProgramResult result = workplace.run("relief-accuracy report made/accuracy.json");
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.error, std::string("relief-accuracy: error: made/accuracy.json: names the "
                                            "picture ") +
                                    file + ", which is outside its folder\n");
    }
}

TEST(AccuracyReportRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write("report.json", json_of(sample_report(), true).dump());
    workplace.write("words.json", "{\"format\": \"another\"}");
    expect_refusals(workplace, "relief-accuracy", "page.html",
                    {{"relief-accuracy report", 2, "REPORT is missing"},
                     {"relief-accuracy report none.json --output out/page.html", 1, "none.json: "},
                     {"relief-accuracy report words.json --output out/page.html", 1,
                      "words.json: /format: is 'another', not 'relief-accuracy'"},
                     {"relief-accuracy report report.json --output report.json", 2,
                      "report.json: would replace the report"},
                     {"relief-accuracy report report.json --output none/page.html", 1,
                      "none/page.html: the folder none does not exist"},
                     {"relief-accuracy report report.json --output out/page.html", 1,
                      "pictures/storage-sample-"}});
}

}  // namespace
}  // namespace relief::tools
