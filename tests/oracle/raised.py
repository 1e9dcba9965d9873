"""placeholder"""
from tests.oracle.contact import Contact


class Raised(Contact):
    pass
