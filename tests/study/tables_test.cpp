#include "apps/study/tables.h"
#include "apps/study/text_table.h"
#include "tests/study/made_study.h"

#include <gmock/gmock.h>

#include <limits>

namespace patchlight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

StudyResult full_study()
{
    StudyResult study = testing::made_study();
    study.gates.min_rate = 0.7;
    study.comparisons = {{StudyComparison::At::elements, {1000, 3000, 9000}}, {StudyComparison::At::seconds, {1}}};
    return study;
}

TEST(TextTableTest, NumbersKeepTheirDigits)
{
    EXPECT_EQ(rounded(12.3456, 3), "12.3");
    EXPECT_EQ(rounded(1.2, 3), "1.20");
    EXPECT_EQ(rounded(9.999, 3), "10.0");
    EXPECT_EQ(rounded(1234.5, 3), "1234") << "no digit before the point is hidden";
    EXPECT_EQ(rounded(0.00123456, 3), "0.00123");
    EXPECT_EQ(rounded(1.234e-6, 2), "1.2e-06");
    EXPECT_EQ(rounded(-2.5, 2), "-2.5");
    EXPECT_EQ(rounded(0, 3), "0");
    EXPECT_EQ(rounded(std::numeric_limits<double>::quiet_NaN(), 3), "–");
    EXPECT_EQ(in_full(0.1), "0.1");
    EXPECT_EQ(in_full(1.0 / 3), "0.3333333333333333");
    EXPECT_EQ(in_full(std::numeric_limits<double>::infinity()), "");
}

TEST(TextTableTest, TextIsNeverMarkup)
{
    EXPECT_EQ(csv_field("plain"), "plain");
    EXPECT_EQ(csv_field("a,\"b\"\n"), "\"a,\"\"b\"\"\n\"");
    EXPECT_EQ(markdown_text("a|b <i>*c*</i>\n`d`"), "a\\|b \\<i\\>\\*c\\*\\</i\\> \\`d\\`");
    EXPECT_EQ(markdown_text("min_rate _x_"), "min_rate \\_x\\_");
    EXPECT_EQ(latex_text("50 % & a_b {x} \\y ~^ $#"),
              "50 \\% \\& a\\_b \\{x\\} \\textbackslash{}y \\textasciitilde{}\\textasciicircum{} \\$\\#");
}

TEST(TextTableTest, EachNotationHasTheSameFields)
{
    const TextTable table{{"name", "n"}, {false, true}, {{"a|b", "1"}, {"ü", "200"}}};
    EXPECT_EQ(markdown(table), "| name |   n |\n| :--- | --: |\n| a\\|b |   1 |\n| ü    | 200 |\n");
    EXPECT_EQ(csv(table), "name,n\r\na|b,1\r\nü,200\r\n");
    EXPECT_EQ(latex(table),
              "% needs \\usepackage{booktabs}\n\\begin{tabular}{lr}\n\\toprule\nname &   n \\\\\n\\midrule\n"
              "a|b  &   1 \\\\\nü    & 200 \\\\\n\\bottomrule\n\\end{tabular}\n");
}

TEST(TablesTest, MarkdownHoldsCellsRatesComparisonsAndGates)
{
    const std::string text = table_text(full_study());
    EXPECT_THAT(text, StartsWith("# made\n\n| refine    | max-elements | cycles | elements | estimated error, % |"));
    // 0.1·(1000/500)^−1 = 5 %, twice that estimated; the rate from the cell before it.
    EXPECT_THAT(text, HasSubstr("| both      | 1000         |      2 |     1000 |               10.0 | "
                                "5.00 (4.50–5.50) |   50.0 | 1.00 |         1.0e-06 | done   |"));
    EXPECT_THAT(text, HasSubstr("| refine=intensity | 0.50 | 0.00 |     4 |"));
    EXPECT_THAT(text, HasSubstr("## At equal elements: error in %"));
    EXPECT_THAT(text, HasSubstr("| refine=intensity | 7.07 (1.41 ×) | 4.08 (2.45 ×) |    — |"));
    EXPECT_THAT(text, HasSubstr("| refine=both      |   5.00 (best) |   1.67 (best) |    — |"));
    EXPECT_THAT(text, HasSubstr("1 of 2 passed."));
    EXPECT_THAT(text, HasSubstr("FAILED"));
}

TEST(TablesTest, TheClockIsInNothingUnlessAskedFor)
{
    StudyResult study = full_study(), later = study;
    for (CellResult& cell : later.cells)
        for (CycleResult& cycle : cell.cycles) cycle.seconds *= 3.7;
    for (const TableFormat format : {TableFormat::markdown, TableFormat::csv, TableFormat::json, TableFormat::latex}) {
        for (const bool cycles : {false, true}) {
            EXPECT_EQ(table_text(study, {format, false, cycles}), table_text(later, {format, false, cycles}));
            EXPECT_NE(table_text(study, {format, true, cycles}), table_text(later, {format, true, cycles}));
        }
    }
    EXPECT_THAT(table_text(study), Not(HasSubstr("seconds")));
    EXPECT_THAT(table_text(study, {TableFormat::markdown, true, false}), HasSubstr("## At equal seconds"));
}

TEST(TablesTest, CsvHasNumbersInFullAndAColumnEach)
{
    const std::string text = table_text(full_study(), {TableFormat::csv, false, false});
    EXPECT_THAT(text, StartsWith("cell,refine,max-elements,cycles,elements,estimated_error,error,error_low,error_high,"
                                 "max_error,rate,energy_residual,status,message\r\n"
                                 "0,intensity,500,2,500,0.2,0.1,"));
    EXPECT_EQ(std::ranges::count(text, '\n'), 9);
    EXPECT_EQ(std::ranges::count(table_text(full_study(), {TableFormat::csv, false, true}), '\n'), 17);
}

TEST(TablesTest, ColumnsOfTheSameNameAreTold)
{
    StudyResult study = testing::made_study();
    study.axes[0].name = "elements";
    EXPECT_THAT(table_text(study, {TableFormat::csv, false, false}),
                StartsWith("cell,elements (option),max-elements,"));
}

TEST(TablesTest, CellsWithoutAResultAreWholeRowsAndSayWhy)
{
    StudyResult study = full_study();
    study.cells[2].status = CellStatus::failed;
    study.cells[2].message = "--rays: 7 | is \"odd\",\nno";
    study.cells[2].cycles.clear();
    study.cells[3].cell.values.clear();
    const std::string text = table_text(study);
    EXPECT_THAT(text, HasSubstr("failed: --rays: 7 \\| is \"odd\", no\n"));
    std::size_t bars = 0, lines = 0;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line) && !line.starts_with("##");) {
        if (!line.starts_with("|")) continue;
        const auto here = static_cast<std::size_t>(std::ranges::count(line, '|'));
        if (lines++ == 0) bars = here;
        EXPECT_EQ(here, bars) << line;
    }
    EXPECT_EQ(lines, 10U);
    EXPECT_THAT(table_text(study, {TableFormat::csv, false, false}),
                HasSubstr("2,intensity,2000,,,,,,,,,,failed,\"--rays: 7 | is \"\"odd\"\",\nno\"\r\n"));
}

TEST(TablesTest, WithoutAReferenceNoColumnPretendsToBeMeasured)
{
    StudyResult study = full_study();
    study.reference.kind = ReferenceKind::none;
    const std::string text = table_text(study);
    EXPECT_THAT(text, AllOf(Not(HasSubstr("| error, %")), HasSubstr("Estimated error ~ elements"),
                            HasSubstr("estimated error in %")));
    EXPECT_EQ(table_json(study)["error"], "estimated");
}

TEST(TablesTest, JsonHoldsEverything)
{
    const Json json = Json::parse(table_text(full_study(), {TableFormat::json, true, true}));
    EXPECT_EQ(json["cells"].size(), 8U);
    EXPECT_EQ(json["cells"][5]["values"]["refine"], "both");
    EXPECT_EQ(json["cells"][5]["cycles"].size(), 2U);
    EXPECT_EQ(json["cells"][5]["result"]["elements"], 1000);
    EXPECT_EQ(json["cells"][5]["result"]["seconds"], 1.0);
    EXPECT_EQ(json["rates"][1]["cells"], Json({4, 5, 6, 7}));
    EXPECT_NEAR(json["rates"][1]["by_elements"]["rate"].get<double>(), 1, 1e-13);
    EXPECT_EQ(json["comparisons"].size(), 4U);
    EXPECT_EQ(json["comparisons"][2]["values"][0]["value"], nullptr);
    EXPECT_EQ(json["gates"][0]["passed"], false);
}

TEST(TablesTest, AStudyWithNothingInItHasATable)
{
    for (const TableFormat format : {TableFormat::markdown, TableFormat::csv, TableFormat::json, TableFormat::latex})
        EXPECT_NE(table_text(StudyResult{}, {format, true, true}), "");
}

}  // namespace
}  // namespace patchlight
