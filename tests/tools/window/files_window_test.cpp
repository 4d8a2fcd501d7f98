// SPDX-License-Identifier: Apache-2.0
// Files that are dropped on the real window or change while it shows them. The result is compared
// with the picture that the same options draw without a window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "relief/mesh/image_file.h"
#include "support/labels.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

FILE_LABELS(window, slow);

using nlohmann::json;
using relief::Image;
using test::changed_picture;
using test::changed_share;
using test::Display;
using test::eventually;
using test::has_effect;
using test::processor_seconds;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;

/// The picture of `relief-view WORDS --output` for the same view.
Image expected_view(const Workplace& workplace, const json& state, const std::string& words) {
    const test::ProgramResult drawn =
        workplace.run("relief-view " + words + " --output out/expected.png " +
                      state["command_line"].get<std::string>());
    EXPECT_EQ(drawn.exit_code, 0) << drawn.error;
    return read_image(workplace / "out/expected.png", ImageUse::color);
}

/// The share of the view that differs from a picture.
double share_unlike(const Display& display, const json& state, const Image& expected) {
    const Image view = test::view_on(display.picture(), state["view"]);
    return changed_share(expected, view, 0, 0, view.width, view.height);
}

/// A dropped height map becomes a normal map.
void drop_height_map(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    const json before = window.wait_for_rest();
    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "data/bricks-height.png"}, 700, 400));
    const json after = window.wait_for(
        "the relief", [](const json& now) { return has_effect(now, "normal map"); });
    EXPECT_EQ(after["camera"], before["camera"]);
    const Image expected =
        expected_view(workplace, after, "data/vase.obj --height-map data/bricks-height.png");
    EXPECT_TRUE(eventually([&] { return share_unlike(display, after, expected) < 0.002; }));
    EXPECT_GT(share_unlike(display, after, expected_view(workplace, after, "data/vase.obj")), 0.05)
        << "and that differs from the plain model";
}

/// Six dropped images become one environment.
void drop_faces(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    std::vector<std::filesystem::path> faces;
    for (const char* name : {"posy", "negz", "posx", "negx", "posz", "negy"})  // In no order.
        faces.push_back(workplace / "data/sky" / (std::string(name) + ".jpg"));
    ASSERT_TRUE(test::drop_files(display.name(), faces, 700, 400));
    const json after =
        window.wait_for("the sky", [](const json& now) { return has_effect(now, "skybox"); });
    const Image expected =
        expected_view(workplace, after,
                      "data/vase.obj --height-map data/bricks-height.png --environment data/sky");
    EXPECT_TRUE(eventually([&] { return share_unlike(display, after, expected) < 0.002; }));
}

/// A scene file replaces the model and has its own camera.
void drop_scene(ViewerWindow& window, const Display& display, const Workplace& workplace,
                const std::string& name) {
    const Image before = display.resting_picture();
    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "data/scenes" / name}, 700, 400));
    const json after = window.wait_for("the scene", [&](const json& now) {
        return now["model"].get<std::string>().ends_with(name);
    });
    const json file = json::parse(workplace.read("data/scenes/" + name));
    EXPECT_EQ(after["error"], "");
    EXPECT_EQ(after["lights"].size(), file["lights"].size());
    EXPECT_NEAR(after["camera"]["fov"].get<double>(), file["camera"]["fov"].get<double>(), 1e-3);
    EXPECT_TRUE(eventually(
        [&] { return changed_share(before, display.picture(), 390, 10, 880, 760) > 0.1; }));
}

/// Hidden instances are not drawn.
void hide_and_show(ViewerWindow& window, const Display& display) {
    const json state = window.wait_for_rest();
    EXPECT_EQ(state["shown"], json({3, 3}));
    window.click_on("tree");
    const auto click = [&](int shown) {
        const Image before = display.resting_picture();
        window.click_on("show normal map");
        const json now = window.wait_for("other things", [&](const json& seen) {
            return seen["shown"] == json({shown, 3});
        });
        EXPECT_TRUE(eventually([&] {
            return changed_share(before, display.picture(), 390, 10, 880, 760, 2) > 0.005;
        }));
        return now;
    };
    EXPECT_FALSE(has_effect(click(2), "normal map")) << "what it alone needs is not there either";
    EXPECT_EQ(click(3)["effects"], state["effects"]);
}

/// The dialog lists the folder of the model, and Page down opens the next model of it.
void open_by_dialog_and_key(ViewerWindow& window) {
    const auto shows = [](const std::string& name) {
        return [name](const json& now) { return now["model"].get<std::string>().ends_with(name); };
    };
    window.key("ctrl+o");
    window.wait_for("the dialog", [](const json& now) { return now["places"].contains("path"); });
    window.click_on("shading-lights.json");
    window.wait_for("the selected scene", shows("shading-lights.json"));
    window.key("Next");
    window.wait_for("the next scene", shows("shading-reflection.json"));
    window.key("F1");
    window.wait_for("help", [](const json& now) { return now["help"] == true; });
    window.key("Escape");
    window.wait_for("no help", [](const json& now) { return now["help"] == false; });
}

TEST(Drops, ScenesModelsMapsAndFacesAreShown) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    window.wait_for_rest();
    drop_scene(window, *display, workplace, "shading-lights.json");
    drop_scene(window, *display, workplace, "shading-bump.json");
    hide_and_show(window, *display);
    open_by_dialog_and_key(window);
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "data/vase.obj"}, 700, 400));
    window.wait_for("the model", [](const json& now) {
        return now["model"].get<std::string>().ends_with("vase.obj");
    });
    drop_height_map(window, *display, workplace);
    drop_faces(window, *display, workplace);
}

/// Replaces a file by renaming, as editors do.
void replace(const Workplace& workplace, const std::string& name, const std::string& text) {
    workplace.write("new-" + name, text);
    std::filesystem::rename(workplace / ("new-" + name), workplace / name);
}

/// A flat grid of size x size squares.
void write_grid(const std::filesystem::path& file, int size) {
    std::ofstream out(file);
    for (int i = 0; i <= size * (size + 2); ++i)
        out << "v " << i % (size + 1) << ' ' << i / (size + 1) << " 0\n";
    for (int i = 0; i < size * size; ++i) {
        const int a = 1 + i % size + (size + 1) * (i / size);
        out << "f " << a << ' ' << a + 1 << ' ' << a + size + 2 << ' ' << a + size + 1 << '\n';
    }
}

void write_color(const std::filesystem::path& file, std::uint8_t red, std::uint8_t green) {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 16; ++i)
        codes.insert(codes.end(), {red, green, 0});
    const Image image{4, 4, 3, ColorSpace::srgb, codes};
    write_image(file, image);
}

TEST(ReloadWindow, ChangedModelKeepsTheViewAndTheEdits) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    const std::string vase = workplace.read("data/vase.obj");
    workplace.write("vase.obj", vase);
    ViewerWindow window(*display, workplace, "vase.obj");
    window.wait_for_rest();
    window.drag(700, 300, 100, 40);
    window.click_on("Lights");
    const json dark = window.wait_for_rest();
    const Image dark_picture = display->resting_picture();
    window.click_on("Add directional");
    const json before = window.wait_for(
        "a light more", [](const json& now) { return now["directional_lights"].size() == 3; });
    EXPECT_EQ(dark["directional_lights"].size(), 2U);
    EXPECT_EQ(before["camera"], dark["camera"]) << "a click on a panel is none on the picture";
    EXPECT_GT(before["revision"], dark["revision"]);
    EXPECT_TRUE(
        eventually([&] { return changed_picture(dark_picture, display->picture()) > 0.05; }));
    const Image picture = display->resting_picture();

    replace(workplace, "vase.obj", vase + "v 9 0 0\nv 9 1 0\nv 9 0 1\nf -3 -2 -1\n");
    const json after = window.wait_for("a triangle more", [&](const json& now) {
        return now["triangles"] == before["triangles"].get<int>() + 1 &&
               now["drawn"]["revision"] == now["revision"];
    });
    EXPECT_EQ(after["scenes"], 2);
    EXPECT_EQ(after["camera"], before["camera"]);
    EXPECT_EQ(after["directional_lights"].size(), 3U) << "an edit stays";
    EXPECT_GT(after["edits"]["kept"], 0);
    EXPECT_EQ(after["error"], "");

    replace(workplace, "vase.obj", vase.substr(0, vase.size() / 2) + "\nf 1 2 999999\n");
    const json broken =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("vase.obj"));
    EXPECT_EQ(broken["triangles"], after["triangles"]) << "the old one stays";

    replace(workplace, "vase.obj", vase);
    const json mended = window.wait_for("the old model", [&](const json& now) {
        return now["error"] == "" && now["triangles"] == before["triangles"] &&
               now["drawn"]["revision"] == now["revision"];
    });
    EXPECT_EQ(mended["camera"], before["camera"]);
    EXPECT_EQ(mended["directional_lights"].size(), 3U);
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) == 0.0; }))
        << "the same picture again";

    // Edits also stay when a map is dropped.
    ASSERT_TRUE(
        test::drop_files(display->name(), {workplace / "data/bricks-height.png"}, 700, 400));
    const json mapped =
        window.wait_for("the map", [](const json& now) { return now["scenes"] == 4; });
    EXPECT_EQ(mapped["directional_lights"].size(), 3U);
    EXPECT_THAT(mapped["edits"]["lost"], testing::IsEmpty());
}

/// A changed texture is drawn, and a damaged one is reported.
void change_texture(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    window.wait_for_rest();
    const Image red = display.resting_picture();
    write_color(workplace / "paint.png", 20, 200);
    EXPECT_TRUE(eventually([&] { return changed_picture(red, display.picture()) > 0.5; }));
    const json green = window.wait_for_rest();
    const Image picture = display.resting_picture();

    workplace.write("paint.png", "no image");
    const json broken =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("paint.png"));
    EXPECT_EQ(changed_picture(picture, display.resting_picture()), 0.0) << "the old one stays";
    EXPECT_EQ(broken["camera"], green["camera"]);

    write_color(workplace / "paint.png", 200, 150);
    window.wait_for("no error", [](const json& now) { return now["error"] == ""; });
    EXPECT_TRUE(eventually([&] { return changed_picture(red, display.picture()) == 0.0; }));
}

/// A changed shader is linked, and a damaged one is reported.
void change_shader(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    const json before = window.wait_for_rest();
    const Image plain = display.resting_picture();
    const std::string head = "//@part lambert\n//@include \"inputs.glsl#diffuse_color\"\n";
    const std::string shader = "shaders/phong.glsl";
    workplace.write(shader, head +
                                "vec3 diffuse_scattering(float n_dot_l) {\n"
                                "    return diffuse_color * n_dot_l * vec3(1.0, 0.0, 0.0);\n}\n");
    EXPECT_TRUE(eventually([&] { return changed_picture(plain, display.picture()) > 0.5; }));
    const json red = window.wait_for_rest();
    EXPECT_EQ(red["relinked"], 1);
    EXPECT_EQ(red["camera"], before["camera"]);
    const Image picture = display.resting_picture();

    workplace.write(shader, head + "vec3 diffuse_scattering(float n) { return broken; }\n");
    const json broken =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("phong.glsl:3"));
    EXPECT_EQ(changed_picture(picture, display.resting_picture()), 0.0) << "the old one stays";
    window.key("7");  // And can still be looked at, from above.
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display.picture()) > 0.05; }));
    window.wait_for_rest();  // A pending picture would use the repaired shader too early.

    std::filesystem::remove(workplace / shader);
    const json mended =
        window.wait_for("no error", [](const json& now) { return now["error"] == ""; });
    EXPECT_EQ(mended["relinked"], 3);
    EXPECT_EQ(mended["scenes"], before["scenes"]) << "no file of the model has changed";
}

/// The window responds while it reads a large model, and reading can be cancelled.
void read_big_model(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    write_grid(workplace / "big.obj", 1500);
    window.wait_for_rest();
    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "big.obj"}, 700, 400));
    json reading;
    ASSERT_TRUE(eventually([&] {
        reading = window.state();
        return reading["loading"] == true && reading["progress"]["stage"] != "";
    }));
    window.key("h");  // It answers meanwhile.
    EXPECT_TRUE(eventually([&] { return window.state()["help"] == true; }));
    window.key("h");
    EXPECT_TRUE(eventually([&] { return window.state()["help"] == false; }));
    EXPECT_EQ(window.state()["loading"], true) << "a machine too quick for this test";
    window.click_on("Cancel");
    const json cancelled = window.wait_for("rest", [](const json&) { return true; });
    EXPECT_EQ(cancelled["triangles"], 2);
    EXPECT_EQ(cancelled["error"], "");
    // No work continues in the background.
    double used = 0.0;
    EXPECT_TRUE(eventually([&] {
        const double last = std::exchange(used, processor_seconds(window.process().pid()));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        return used - last < 0.02;
    }));
    EXPECT_EQ(window.state()["triangles"], 2);

    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "big.obj"}, 700, 400));
    ASSERT_TRUE(eventually([&] { return window.state()["loading"] == true; }));
    window.key("ctrl+q");
    EXPECT_EQ(window.process().wait_for_end(100.0), 0) << window.error_output();
}

TEST(ReloadWindow, TexturesShadersAndLargeModelsAreReadInTheBackground) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    write_color(workplace / "paint.png", 200, 150);
    std::filesystem::create_directories(workplace / "shaders");
    ViewerWindow window(*display, workplace, "square.obj --diffuse-map paint.png",
                        "RELIEF_SHADER_DIR=shaders");
    change_texture(window, *display, workplace);
    change_shader(window, *display, workplace);
    read_big_model(window, *display, workplace);
}

TEST(ReloadWindow, UnreadableModelIsShownAfterItsRepair) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write("model.obj", "f 1 2 3\n");
    ViewerWindow window(*display, workplace, "model.obj --size 500x400");
    const json broken =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("model.obj"));
    EXPECT_EQ(broken["drawn"]["frames"], 0);
    workplace.write_square("model.obj");
    window.wait_for("the model", [](const json& now) {
        return now["error"] == "" && now.value("triangles", 0) == 2;
    });
    window.wait_for("the view in the size that was asked for", [](const json& now) {
        return now["view"] == json({500, 400}) && now["drawn"]["size"] == now["view"];
    });
    window.key("Next");
    window.wait_for("a notice", [](const json& now) {
        return now["notice"] == "There is no other model in the folder";
    });
    // A damaged file that is dropped must not stop the watch on the first file.
    workplace.write("broken.glb", "this is no model");
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "broken.glb"}, 200, 150));
    window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    replace(workplace, "model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const json now = window.wait_for("the other model", [](const json& state) {
        return state["error"] == "" && state["triangles"] == 1;
    });
    EXPECT_EQ(now["scenes"], 2);
    window.key("ctrl+q");
    EXPECT_EQ(window.process().wait_for_end(100.0), 0);
}

}  // namespace
}  // namespace relief::tools
