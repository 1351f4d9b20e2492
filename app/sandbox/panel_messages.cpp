// What the program has to say.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

float messages_height(const Messages &messages, float width) {
    if (messages.empty())
        return 0;
    const ImGuiStyle &style = ImGui::GetStyle();
    float height = 2 * style.WindowPadding.y - style.ItemSpacing.y;
    for (const Message &message : messages.all())
        height += style.ItemSpacing.y +
                  ImGui::CalcTextSize(message.text.c_str(), nullptr, false,
                                      width - 2 * style.WindowPadding.x - style.ScrollbarSize)
                      .y;
    return height;
}

void messages_panel(PanelContext &context) {
    // The newest on top, where it is seen even if there are many.
    const std::vector<Message> &messages = context.session.messages().all();
    for (auto at = messages.rbegin(); at != messages.rend(); ++at) {
        const Message &message = *at;
        const Colour &colour = message.severity == Message::Severity::error     ? theme::error
                               : message.severity == Message::Severity::warning ? theme::warning
                                                                                : theme::text;
        ImGui::PushStyleColor(ImGuiCol_Text, colour);
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(message.text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
    }
}

} // namespace plumb
