target_sources(lucent_gl PRIVATE ImGuiHost.cpp)
target_link_libraries(lucent_gl PUBLIC imgui)
