from hitbox.physics import Circle, Polygon, World

world = World(gravity=(0, 0))
world.add_body(Polygon.box(60, 60), position=(100, 100), user="box")
world.add_body(Circle(10), position=(110, 110), user="coin")

mouse = (112, 108)  # pygame.mouse.get_pos(), in the world's pixels
under = [body.user for body in world.query_point(mouse)]  # in the order of adding
body, point, away = world.closest((200, 100))
inside = world.query_rect((90, 90, 40, 40))  # or a pygame.Rect: the bodies whose bounds overlap it

print("under the mouse:", under, "- nearest:", body.user, f"{away:.0f} px away at {point}")
assert under == ["box", "coin"] and body.user == "box" and away == 70 and len(inside) == 2
