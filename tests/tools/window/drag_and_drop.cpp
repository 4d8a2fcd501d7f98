// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>

#include "tools/window/display.h"

// This header must be the last one, because it defines macros such as None.
#include <X11/Xlib.h>

namespace relief::test {
namespace {

class Source {
  public:
    Source(const std::string& display, const std::vector<std::filesystem::path>& files)
        : display_(XOpenDisplay(display.c_str()), XCloseDisplay) {
        if (!display_) return;
        window_ = XCreateSimpleWindow(x(), DefaultRootWindow(x()), 0, 0, 1, 1, 0, 0, 0);
        target_ = find_target();
        for (const std::filesystem::path& file : files)
            list_ += "file://" + std::filesystem::absolute(file).string() + "\r\n";
    }

    bool drop(int left, int top) {
        if (!display_ || target_ == None) return false;
        XSetSelectionOwner(x(), atom("XdndSelection"), window_, CurrentTime);
        send("XdndEnter", {5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0});
        send("XdndPosition",
             {0, left << 16 | top, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
        if (!answers("XdndStatus")) return false;
        send("XdndDrop", {0, CurrentTime, 0, 0});
        return answers("XdndFinished");
    }

  private:
    [[nodiscard]] ::Display* x() const { return display_.get(); }
    [[nodiscard]] Atom atom(const char* name) const { return XInternAtom(x(), name, False); }

    [[nodiscard]] bool takes_drops(Window window) const {
        Atom type = None;
        int format = 0;
        unsigned long count = 0, rest = 0;
        unsigned char* data = nullptr;
        XGetWindowProperty(x(), window, atom("XdndAware"), 0, 1, False, AnyPropertyType, &type,
                           &format, &count, &rest, &data);
        if (data != nullptr) XFree(data);
        XWindowAttributes attributes;
        XGetWindowAttributes(x(), window, &attributes);
        return type != None && attributes.map_state == IsViewable;
    }

    /// Without a window manager, windows are children of the root window.
    [[nodiscard]] Window find_target() const {
        Window root = None, parent = None, found = None;
        Window* children = nullptr;
        unsigned count = 0;
        XQueryTree(x(), DefaultRootWindow(x()), &root, &parent, &children, &count);
        for (unsigned i = 0; i < count; ++i) {
            if (takes_drops(children[i])) found = children[i];
        }
        if (children != nullptr) XFree(children);
        return found;
    }

    void send(const char* type, const std::array<long, 4>& words) const {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(window_);
        for (std::size_t i = 0; i < words.size(); ++i)
            event.xclient.data.l[i + 1] = words[i];
        XSendEvent(x(), target_, False, NoEventMask, &event);
        XFlush(x());
    }

    /// Answers a request for the list of files.
    void give(const XSelectionRequestEvent& request) const {
        XChangeProperty(x(), request.requestor, request.property, request.target, 8,
                        PropModeReplace, reinterpret_cast<const unsigned char*>(list_.data()),
                        static_cast<int>(list_.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.property;
        event.xselection.time = request.time;
        XSendEvent(x(), request.requestor, False, NoEventMask, &event);
        XFlush(x());
    }

    /// Serves the target until it sends this message.
    bool answers(const char* type) const {
        const Atom awaited = atom(type);
        return eventually([&] {
            while (XPending(x()) > 0) {
                XEvent event;
                XNextEvent(x(), &event);
                if (event.type == SelectionRequest) give(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == awaited)
                    return true;
            }
            return false;
        });
    }

    std::unique_ptr<::Display, int (*)(::Display*)> display_;
    Window window_ = None;
    Window target_ = None;
    std::string list_;
};

}  // namespace

bool drop_files(const std::string& display, const std::vector<std::filesystem::path>& files, int x,
                int y) {
    return Source(display, files).drop(x, y);
}

}  // namespace relief::test
