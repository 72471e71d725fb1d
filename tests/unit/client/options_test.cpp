#include "client/options.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using testing::HasSubstr;

Options parse(const std::vector<std::string>& arguments, const std::string& environment = "") {
    return parse_options(arguments, {environment, ""});
}

/// The message of the bad_input error that parsing ends in; fails the test where there is none.
std::string complaint(const std::vector<std::string>& arguments) {
    try {
        parse(arguments);
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
}

TEST(Options, ReadsEverySettingOfSubmit) {
    const auto options = parse({"submit",       "scene.glb", "--frames",     "3-9",
                                "--fps",        "12.5",      "--size",       "320x180",
                                "--quality",    "draft",     "--method",     "full",
                                "--visibility", "retrace",   "--solution",   "progressive",
                                "--rays",       "128",       "--patch-size", "0.2",
                                "--error",      "2%",        "--estimate",   "probes",
                                "--camera",     "Camera 2",  "--seed",       "18446744073709551615",
                                "--exposure",   "-1.5",      "--background", "0,.5,1"});
    const Json settings = settings_json(std::get<SubmitCommand>(options.command).settings);
    const Json expected =
        Json::parse(R"({"frames":"3-9","fps":12.5,"width":320,"height":180,"quality":"draft",
        "estimate":"probes","method":"full","visibility":"retrace","solution":"progressive","rays":128,"patch_size_m":0.2,
        "error":0.02,"camera":"Camera 2","seed":18446744073709551615,"exposure_ev":-1.5,
        "background":[0.0,0.5,1.0]})");
    EXPECT_EQ(settings, expected);
}

TEST(Options, SendsOnlyWhatWasGiven) {
    const auto options = parse({"submit", "scene.glb"});
    const auto& submit = std::get<SubmitCommand>(options.command);
    EXPECT_EQ(settings_json(submit.settings), Json::object());
    EXPECT_EQ(submit.scene, "scene.glb");
    EXPECT_EQ(submit.follow, Follow::detach);
    EXPECT_FALSE(submit.paths || submit.out || submit.obj_unit_m || submit.obj_up);
}

TEST(Options, ReadsTheRestOfSubmit) {
    const auto options =
        parse({"submit", "--json", "a.obj", "--paths", "p.json", "--unit", "cm", "--up", "z"});
    const auto& submit = std::get<SubmitCommand>(options.command);
    EXPECT_EQ(options.format, OutputFormat::json);
    EXPECT_EQ(submit.paths, "p.json");
    EXPECT_EQ(submit.obj_unit_m, 0.01);
    EXPECT_EQ(submit.obj_up, "z");
}

TEST(Options, WatchesWhenAFolderForFramesIsGiven) {
    EXPECT_EQ(std::get<SubmitCommand>(parse({"submit", "a.glb", "--watch"}).command).follow, Follow::watch);
    const auto options = parse({"submit", "a.glb", "--out", "frames"});
    EXPECT_EQ(std::get<SubmitCommand>(options.command).follow, Follow::watch);
    EXPECT_EQ(std::get<SubmitCommand>(options.command).out, "frames");
}

TEST(Options, ReadsTheOtherCommands) {
    EXPECT_EQ(std::get<WatchCommand>(parse({"watch", "j1"}).command).id, "j1");
    EXPECT_EQ(std::get<ShowCommand>(parse({"show", "j1"}).command).id, "j1");
    for (const Step step : {Step::pause, Step::resume, Step::cancel, Step::retry}) {
        const auto command = std::get<StepCommand>(parse({std::string(name_of(step)), "j1"}).command);
        EXPECT_EQ(command.id, "j1");
        EXPECT_EQ(command.step, step);
    }
    EXPECT_EQ(std::get<PriorityCommand>(parse({"priority", "j1", "7"}).command).priority, 7);
    EXPECT_EQ(std::get<PriorityCommand>(parse({"priority", "j1", "-10"}).command).priority, -10);
    for (const char* bad : {"11", "-11", "1.5", "high"})
        EXPECT_THROW(parse({"priority", "j1", bad}), ClientError) << bad;
    EXPECT_EQ(std::get<RemoveCommand>(parse({"rm", "j1"}).command).removal, Removal::done);
    EXPECT_EQ(std::get<RemoveCommand>(parse({"rm", "j1", "--dry-run"}).command).removal, Removal::tried);
    EXPECT_TRUE(std::holds_alternative<DoctorCommand>(parse({"doctor"}).command));
    EXPECT_TRUE(std::holds_alternative<CompletionCommand>(parse({"completion"}).command));
    EXPECT_TRUE(std::holds_alternative<ListCommand>(parse({"ls"}).command));
    const auto get = std::get<GetCommand>(parse({"get", "j1", "-o", "d", "--type", "exr"}).command);
    EXPECT_EQ(get.id, "j1");
    EXPECT_EQ(get.out, "d");
    EXPECT_EQ(get.type, PictureType::exr);
    EXPECT_EQ(std::get<GetCommand>(parse({"get", "j1", "-o", "d"}).command).type, PictureType::both);
    EXPECT_EQ(std::get<GetCommand>(parse({"get", "j1", "-o", "d", "--movie", "m.mp4"}).command).movie,
              "m.mp4");
}

TEST(Options, TakesTheTokenFromItsFileThenFromTheEnvironment) {
    const auto file = std::filesystem::path(testing::TempDir()) / "token";
    const auto given = [&](const std::string& content) {
        std::ofstream(file) << content;
        return std::vector<std::string>{"ls", "--token-file", file.string()};
    };
    EXPECT_EQ(parse_options({"ls"}, {"", "from-environment"}).token, "from-environment");
    EXPECT_EQ(parse_options(given("from-file\n"), {"", "from-environment"}).token, "from-file");
    for (const char* bad : {"", "\n", "two words", "two\nlines", "bell\a"})
        EXPECT_THAT(complaint(given(bad)), HasSubstr("--token-file")) << bad;
    EXPECT_THAT(complaint({"ls", "--token-file", "/no/such/file"}), HasSubstr("/no/such/file"));
}

TEST(Options, TakesTheServerBeforeOrAfterTheCommandThenFromTheEnvironment) {
    EXPECT_EQ(parse({"--server", "http://a:1", "ls"}, "http://b").server, "http://a:1");
    EXPECT_EQ(parse({"ls", "--server", "http://a:1"}, "http://b").server, "http://a:1");
    EXPECT_EQ(parse({"ls"}, "http://b").server, "http://b");
    EXPECT_EQ(parse({"ls"}).server, "http://127.0.0.1:8080");
}

TEST(Options, HintsAtTheServerOnlyWhereItWasNamedOnTheCommandLine) {
    EXPECT_EQ(parse({"ls", "--server", "a:1"}).server_hint, " --server http://a:1");
    EXPECT_EQ(parse({"ls"}, "http://b").server_hint, "");
}

TEST(Options, ShowsHelpWithTheExitCodes) {
    const auto help = std::get<HelpCommand>(parse({"--help"}).command).text;
    EXPECT_THAT(help, HasSubstr("submit"));
    EXPECT_THAT(help, HasSubstr("130"));
    EXPECT_THAT(std::get<HelpCommand>(parse({"submit", "--help"}).command).text, HasSubstr("--patch-size"));
}

TEST(Options, RefusesWhatItDoesNotKnow) {
    EXPECT_THAT(complaint({}), HasSubstr("subcommand"));
    EXPECT_THAT(complaint({"fly"}), HasSubstr("there is no command \"fly\" (see --help)"));
    EXPECT_THAT(complaint({"--fly"}), HasSubstr("subcommand"));
    EXPECT_THAT(complaint({"submit"}), HasSubstr("SCENE"));
    EXPECT_THAT(complaint({"submit", "a.glb", "--frame", "1"}), HasSubstr("--frame"));
    EXPECT_THAT(complaint({"submit", "a.glb", "--rays", "many"}), HasSubstr("--rays"));
    EXPECT_THAT(complaint({"submit", "a.obj", "--up", "x"}), HasSubstr("--up"));
    EXPECT_THAT(complaint({"get", "j1"}), HasSubstr("--out"));
    EXPECT_THAT(complaint({"get", "j1", "-o", "d", "--type", "jpg"}), HasSubstr("--type"));
    EXPECT_THAT(complaint({"watch", ""}), HasSubstr("ID"));
    EXPECT_THAT(complaint({"get", "j1", "-o", "d", "--type", "exr", "--movie", "m.mp4"}),
                HasSubstr("--movie"));
}

TEST(Options, ReadsSizes) {
    EXPECT_EQ(parse_size("640x360"), std::pair(640, 360));
    EXPECT_EQ(parse_size("1x16384"), std::pair(1, 16384));
    for (const char* bad : {"", "x", "640", "640x", "x360", "640x360x2", "0x1", "1x16385", "-1x1", "6 4x3",
                            "99999999999x1", "640X360"})
        EXPECT_THROW(parse_size(bad), ClientError) << bad;
}

TEST(Options, ReadsErrorsAsNumbersAndPercentages) {
    EXPECT_DOUBLE_EQ(parse_share("0.02"), 0.02);
    EXPECT_DOUBLE_EQ(parse_share("2%"), 0.02);
    EXPECT_DOUBLE_EQ(parse_share(".5%"), 0.005);
    for (const char* bad : {"", "%", "0", "1", "100%", "-2%", "2%%", "nan", "inf", "two", "2 %", "1e999"})
        EXPECT_THROW(parse_share(bad), ClientError) << bad;
}

TEST(Options, ReadsColoursAndUnits) {
    EXPECT_EQ(parse_rgb("0.2,0,3"), (std::vector<double>{0.2, 0, 3}));
    for (const char* bad : {"", "1", "1,2", "1,2,3,4", "1,2,", "1,-2,3", "1,nan,3", "a,b,c"})
        EXPECT_THROW(parse_rgb(bad), ClientError) << bad;
    EXPECT_DOUBLE_EQ(parse_unit("in"), 0.0254);
    EXPECT_DOUBLE_EQ(parse_unit("2.5"), 2.5);
    for (const char* bad : {"", "km", "0", "-1", "inf"}) EXPECT_THROW(parse_unit(bad), ClientError) << bad;
}

}  // namespace
}  // namespace afterglow::client
