#include "client/edit_options.h"

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using testing::HasSubstr;

Command command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "edit");
    return parse_options(arguments, {}).command;
}

Json edits(const std::vector<std::string>& arguments) {
    return std::get<EditCommand>(command(arguments)).edits;
}

std::string complaint(const std::vector<std::string>& arguments) {
    try {
        command(arguments);
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
}

TEST(EditOptions, EveryKindIsAsTheInterfaceHasIt) {
    EXPECT_EQ(
        edits({"move", "j1", "chair", "--by", "-0.5,0,1e-1", "--turn", "-30"}),
        Json::parse(R"([{"move":{"node":"chair","translation":[-0.5,0.0,0.1],"rotation":[0,1,0,-30.0]}}])"));
    EXPECT_EQ(edits({"light", "j1", "lamp", "--scale", "0"}),
              Json::parse(R"([{"light":{"name":"lamp","scale":0.0}}])"));
    EXPECT_EQ(edits({"light", "j1", "lamp", "--emission", "3,2,1"}),
              Json::parse(R"([{"light":{"material":"lamp","emission":[3.0,2.0,1.0]}}])"));
    EXPECT_EQ(edits({"light", "j1", "spot", "--intensity", "3,2,1"}),
              Json::parse(R"([{"light":{"lamp":"spot","intensity":[3.0,2.0,1.0]}}])"));
    EXPECT_EQ(edits({"material", "j1", "wall", "--reflectance", ".5,.4,.3"}),
              Json::parse(R"([{"material":{"material":"wall","reflectance":[0.5,0.4,0.3]}}])"));
    EXPECT_EQ(edits({"camera", "j1", "--camera", "side"}), Json::parse(R"([{"camera":{"camera":"side"}}])"));
    EXPECT_EQ(edits({"camera", "j1", "--position", "1,1,1", "--look-at", "0,0,0"}),
              Json::parse(R"([{"camera":{"position":[1.0,1.0,1.0],"look_at":[0.0,0.0,0.0]}}])"));
    EXPECT_EQ(edits({"remove", "j1", "rug"}), Json::parse(R"([{"remove":{"node":"rug"}}])"));
}

TEST(EditOptions, TheRestIsRead) {
    const auto file = std::get<EditCommand>(command({"file", "j1", "e.json", "--retry"}));
    EXPECT_EQ(file.id, "j1");
    EXPECT_EQ(file.file, "e.json");
    EXPECT_EQ(file.on_conflict, OnConflict::retry);
    EXPECT_EQ(std::get<EditCommand>(command({"remove", "j1", "rug"})).on_conflict, OnConflict::fail);
    EXPECT_EQ(std::get<EditableCommand>(command({"show", "j1"})).id, "j1");
    EXPECT_EQ(parse_options({"edit", "remove", "j1", "rug", "--json"}, {}).format, OutputFormat::json);
    EXPECT_EQ(parse_options({"edit", "remove", "j1", "rug", "--server", "http://a"}, {}).server, "http://a");
}

TEST(EditOptions, PathsAndFurnitureComeFromFiles) {
    const auto path = std::get<EditCommand>(command({"path", "j1", "robot", "way.json", "--from", "1.5"}));
    EXPECT_EQ(path.file, "way.json");
    EXPECT_EQ(path.file_holds, EditCommand::FileHolds::keys);
    EXPECT_EQ(path.edits, Json::parse(R"([{"path":{"node":"robot","from_s":1.5}}])"));
    const auto add =
        std::get<EditCommand>(command({"add", "j1", "shelf", "shelf.json", "--at", "1,0,2", "--turn", "90"}));
    EXPECT_EQ(add.file, "shelf.json");
    EXPECT_EQ(add.file_holds, EditCommand::FileHolds::geometry);
    EXPECT_EQ(
        add.edits,
        Json::parse(R"([{"add":{"node":"shelf","translation":[1.0,0.0,2.0],"rotation":[0,1,0,90.0]}}])"));
    EXPECT_EQ(std::get<EditCommand>(command({"file", "j1", "e.json"})).file_holds,
              EditCommand::FileHolds::request);
    EXPECT_THAT(complaint({"path", "j1", "robot"}), HasSubstr("FILE"));
    EXPECT_THAT(complaint({"add", "j1", "shelf", "s.json", "--at", "1,2"}), HasSubstr("--at"));
}

TEST(EditOptions, WhatIsWrongIsNamed) {
    EXPECT_THAT(complaint({"move", "j1", "chair"}), HasSubstr("--by or --turn"));
    EXPECT_THAT(complaint({"move", "j1", "chair", "--by", "1,2"}), HasSubstr("--by: \"1,2\""));
    EXPECT_THAT(complaint({"move", "j1", "chair", "--by", "1,2,x"}), HasSubstr("--by"));
    EXPECT_THAT(complaint({"move", "j1", "chair", "--by", "1,2,inf"}), HasSubstr("--by"));
    EXPECT_THAT(complaint({"light", "j1", "lamp"}), HasSubstr("--scale, --emission or --intensity"));
    EXPECT_THAT(complaint({"light", "j1", "lamp", "--emission", "1,1,1", "--intensity", "1,1,1"}),
                HasSubstr("--help"));
    EXPECT_THAT(complaint({"light", "j1", "lamp", "--intensity", "1"}), HasSubstr("--intensity: \"1\""));
    EXPECT_THAT(complaint({"light", "j1", "lamp", "--scale", "1", "--emission", "1,1,1"}),
                HasSubstr("--help"));
    EXPECT_THAT(complaint({"camera", "j1"}), HasSubstr("--camera"));
    EXPECT_THAT(complaint({"material", "j1", "wall"}), HasSubstr("--reflectance"));
    EXPECT_THAT(complaint({"remove", "", "wall"}), HasSubstr("ID"));
    EXPECT_THAT(complaint({}), HasSubstr("--help"));
}

}  // namespace
}  // namespace afterglow::client
