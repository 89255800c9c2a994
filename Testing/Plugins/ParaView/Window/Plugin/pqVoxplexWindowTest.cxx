// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqVoxplexWindowTest.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqPropertiesPanel.h"
#include "pqPropertyWidget.h"
#include "pqRenderView.h"
#include "pqSearchBox.h"
#include "pqServer.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkXMLImageDataWriter.h"

#include <QAbstractButton>
#include <QApplication>
#include <QDialog>
#include <QDockWidget>
#include <QElapsedTimer>
#include <QIcon>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListView>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QProcess>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QTimer>
#include <QToolButton>

#include <cmath>
#include <iostream>
#include <vector>

namespace
{
const char MeshLabel[] = "Mesh Segmentation (Tetrahedralize)";
const char SeriesLabel[] = "Mesh Segmentation Series (Space-Time)";
const char SliceLabel[] = "Space-Time Mesh Slice";
const char QualityLabel[] = "Segmentation Mesh Quality";

QStringList Messages; ///< of Qt

/** An action's text without the & of its shortcut. */
QString textOf(const QAction* action)
{
  return action->text().remove('&');
}
/** A click of the user, through the X server. */
void click(const QWidget* widget)
{
  const QPoint at = widget->mapToGlobal(widget->rect().center());
  QProcess::startDetached(
    "xdotool", { "mousemove", QString::number(at.x()), QString::number(at.y()), "click", "1" });
}
/** An image of one label, 3, that is called liver. */
void writeNamedImage(const QString& path)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 4, 4);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  image->GetPointData()->GetScalars()->Fill(3);
  vtkNew<vtkIntArray> values;
  values->SetName("LabelValues");
  values->InsertNextValue(3);
  vtkNew<vtkStringArray> names;
  names->SetName("LabelNames");
  names->InsertNextValue("liver");
  image->GetFieldData()->AddArray(values);
  image->GetFieldData()->AddArray(names);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(path.toUtf8().data());
  writer->SetInputData(image);
  writer->Write();
}
} // namespace

pqVoxplexWindowTest::pqVoxplexWindowTest(QObject* parent)
  : QObject(parent)
{
}

void pqVoxplexWindowTest::startup()
{
  QTimer::singleShot(3000, this, SLOT(run()));
}

void pqVoxplexWindowTest::shutdown() {}

void pqVoxplexWindowTest::check(bool condition, const QString& what)
{
  if (!condition)
  {
    ++this->Failures;
    std::cerr << "FAILED: " << qPrintable(what) << std::endl;
  }
}

void pqVoxplexWindowTest::run()
{
  this->Window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  this->check(this->Window && this->Window->isVisible(), "the window is visible");
  if (this->Window)
  {
    for (QWidget* widget : QApplication::topLevelWidgets()) // the welcome
    {
      if (auto* const dialog = qobject_cast<QDialog*>(widget))
      {
        dialog->close();
      }
    }
    this->Window->showNormal();
    this->Window->resize(1400, 900);
    if (auto* const dock = this->Window->findChild<QDockWidget*>("propertiesDock"))
    {
      this->Window->resizeDocks({ dock }, { 440 }, Qt::Horizontal);
      if (auto* const pipeline = this->Window->findChild<QDockWidget*>("pipelineBrowserDock"))
      {
        this->Window->resizeDocks({ pipeline, dock }, { 150, 600 }, Qt::Vertical);
      }
    }
    this->testMenu();
    this->testQuickLaunch("tetrahedralize", { MeshLabel });
    this->testQuickLaunch("segmentation", { MeshLabel, SeriesLabel });
    this->testQuickLaunch("mesh", { MeshLabel, SeriesLabel, SliceLabel, QualityLabel });
    this->testMeshing();
    this->testPanel();
    this->testColors();
    this->testLabelTable();
    this->testOtherTables();
    this->takePicture();
    this->testWaiting();
    this->testQueued();
    this->testAbort();
    this->testServer();
  }
  std::cout << (this->Failures ? "checks failed" : "all checks passed") << std::endl;
  std::_Exit(this->Failures ? 1 : 0); // without questions about unsaved work
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexWindowTest::wait(int milliseconds)
{
  QElapsedTimer timer;
  timer.start();
  do
  {
    QApplication::processEvents(QEventLoop::AllEvents, 50);
  } while (timer.elapsed() < milliseconds);
}

void pqVoxplexWindowTest::grab(const QString& name)
{
  this->wait(500);
  const QString path = qEnvironmentVariable("VOXPLEX_TEST_OUTPUT") + "/" + name;
  const QRect area = this->Window->frameGeometry();
  const QPixmap picture =
    QApplication::primaryScreen()->grabWindow(0, area.x(), area.y(), area.width(), area.height());
  this->check(picture.save(path), "save " + path);
}

QMenu* pqVoxplexWindowTest::findMenu() const
{
  for (QAction* top : this->Window->menuBar()->actions())
  {
    if (textOf(top) == "Filters" && top->menu())
    {
      for (QAction* action : top->menu()->actions())
      {
        if (textOf(action) == "Voxplex")
        {
          return action->menu();
        }
      }
    }
  }
  return nullptr;
}

QAction* pqVoxplexWindowTest::findAction(const QString& label) const
{
  if (QMenu* const menu = this->findMenu())
  {
    for (QAction* action : menu->actions())
    {
      if (textOf(action) == label)
      {
        return action;
      }
    }
  }
  return nullptr;
}

void pqVoxplexWindowTest::openMenu(const QString& picture)
{
  for (QAction* top : this->Window->menuBar()->actions())
  {
    if (textOf(top) == "Filters" && top->menu())
    {
      top->menu()->popup(this->Window->mapToGlobal(QPoint(190, 20)));
      this->wait(500); // what can be chosen is found out when the menu is about to be shown
      if (QMenu* const menu = this->findMenu())
      {
        menu->popup(this->Window->mapToGlobal(QPoint(455, 440)));
        this->grab(picture);
        menu->close();
      }
      top->menu()->close();
    }
  }
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexWindowTest::testMenu()
{
  this->openMenu("menu.png");
  QMenu* const menu = this->findMenu();
  this->check(menu != nullptr, "Filters > Voxplex is in the menu bar");
  this->check(menu && menu->actions().size() == 6, "it has six filters");
  for (const QString label : { MeshLabel, SeriesLabel, SliceLabel, QualityLabel,
         "Masks To Segmentation", "Repair Segmentation" })
  {
    QAction* const action = this->findAction(label);
    this->check(action != nullptr, "'" + label + "' is in the menu");
    this->check(action && !action->icon().isNull() && !action->icon().pixmap(16).isNull(),
      "'" + label + "' has an icon");
    this->check(action && !action->isEnabled(), "'" + label + "' is greyed out without an input");
  }
}

void pqVoxplexWindowTest::testQuickLaunch(const QString& typed, const QStringList& expected)
{
  // The dialog runs an event loop of its own.
  QTimer::singleShot(500, this,
    [&]
    {
      auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
      this->check(dialog != nullptr, "the quick launch opens");
      if (dialog == nullptr)
      {
        return;
      }
      QWidget* const line = dialog->findChild<QLineEdit*>(); // in ParaView 5.13 and newer
      for (const QChar& letter : typed)
      {
        QKeyEvent press(
          QEvent::KeyPress, Qt::Key_A + letter.unicode() - 'a', Qt::NoModifier, QString(letter));
        QApplication::sendEvent(line ? line : dialog, &press);
      }
      QStringList items;
      for (const auto* view : dialog->findChildren<QListView*>())
      {
        for (int i = 0; i < view->model()->rowCount(); ++i)
        {
          items << view->model()->index(i, view->modelColumn()).data().toString().remove('&');
        }
      }
      for (const QString& label : expected)
      {
        this->check(items.contains(label),
          "the quick launch finds '" + label + "' by '" + typed + "' among " + items.join(", "));
      }
      dialog->reject();
    });
  pqPVApplicationCore::instance()->quickLaunch();
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexWindowTest::apply()
{
  if (auto* const panel = this->Window->findChild<pqPropertiesPanel*>())
  {
    panel->apply();
  }
  this->wait(300);
}

void pqVoxplexWindowTest::testMeshing()
{
  pqServer* const server = pqActiveObjects::instance().activeServer();
  pqObjectBuilder* const builder = pqApplicationCore::instance()->getObjectBuilder();
  this->Reader = builder->createReader("sources", "VoxplexSegmentationReader",
    QStringList(qEnvironmentVariable("VOXPLEX_TEST_ATLAS")), server);
  this->check(this->Reader != nullptr, "the reader");
  this->apply();
  pqActiveObjects::instance().setActiveSource(this->Reader);
  this->wait(300);

  this->openMenu("menu-image.png");
  QAction* const action = this->findAction(MeshLabel);
  this->check(action && action->isEnabled(), "the menu offers the filter for an image");
  QAction* const slice = this->findAction(SliceLabel);
  this->check(slice && !slice->isEnabled(), "the menu does not offer the slice for an image");
  if (action)
  {
    action->trigger();
  }
  this->wait(300);
  this->Mesher = pqActiveObjects::instance().activeSource();
  this->check(this->Mesher && QString(this->Mesher->getProxy()->GetXMLName()) == "VoxplexTetMesh",
    "the menu makes the filter");
  if (this->Mesher)
  {
    this->check(vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").GetAsDouble() == 2.0,
      "the default Delta");
    vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(4.0);
    const double row[] = { 8.0, 3.0, 1.0 };
    vtkSMPropertyHelper(this->Mesher->getProxy(), "LabelTable").Set(row, 3);
    this->apply();
    vtkPVDataInformation* const data = this->Mesher->getOutputPort(0)->getDataInformation();
    this->check(data->GetNumberOfCells() > 10000, "tetrahedra after Apply");
    this->grab("first.png");
    this->testFirstView();
  }
}

/** The whole mesh is in view, without a legend of 116 names. */
void pqVoxplexWindowTest::testFirstView()
{
  auto* const view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  vtkNew<vtkSMTransferFunctionManager> maps;
  vtkSMProxy* const legend = maps->GetScalarBarRepresentation(this->colorMap(), view->getProxy());
  this->check(vtkSMPropertyHelper(legend, "Visibility").GetAsInt() == 0, "no legend of 116 names");
  double bounds[6];
  this->Mesher->getOutputPort(0)->getDataInformation()->GetBounds(bounds);
  vtkRenderer* const renderer = view->getRenderViewProxy()->GetRenderer();
  for (int corner = 0; corner < 8; ++corner)
  {
    renderer->SetWorldPoint(
      bounds[corner & 1], bounds[2 + (corner >> 1 & 1)], bounds[4 + (corner >> 2)], 1.0);
    renderer->WorldToView();
    const double* const at = renderer->GetViewPoint();
    this->check(std::abs(at[0]) < 1.0 && std::abs(at[1]) < 1.0, "the whole mesh is in view");
  }
}

void pqVoxplexWindowTest::testPanel()
{
  auto* const panel = this->Window->findChild<pqPropertiesPanel*>();
  auto* const delta = panel ? panel->findChild<QWidget*>("Delta") : nullptr;
  this->check(delta && delta->isVisible(), "Delta is in the panel");
  this->check(delta && delta->findChild<QWidget*>("ScaleBy") && delta->findChild<QWidget*>("Reset"),
    "with buttons to scale and to reset");
  this->checkShown({ "LabelArray", "InputMode", "LabelTable", "Delta", "NumberOfElements",
                     "Grading", "SmoothingSigma", "Optimise" },
    true);
  this->checkShown({ "NumberOfThreads", "FacetAngle", "SizeImage", "SizeArray", "Force",
                     "Gradation", "Isovalue", "FeatureRatio" },
    false);
  this->grab("panel.png");
  this->grabPanel("properties.png");
  this->testDependentProperties();
  auto* const search = panel ? panel->findChild<pqSearchBox*>() : nullptr;
  auto* const gear = search ? search->findChild<QAbstractButton*>("AdvancedButton") : nullptr;
  this->check(gear != nullptr, "the button for advanced properties");
  if (gear)
  {
    gear->click();
    this->wait(500);
    this->checkShown(
      { "LabelArray", "InputMode", "LabelTable", "SmallestComponent", "MinimumComponentVolume",
        "Delta", "NumberOfElements", "Grading", "SmoothingSigma", "InterfaceTable", "FacetAngle",
        "SampleJunctions", "InterfaceRounds", "Manifold", "ElementSize", "SizeImage", "SizeArray",
        "Gradation", "Optimise", "OptimisationTimeLimit", "RadiusEdgeRatio", "SliverAngle", "Force",
        "NumberOfThreads", "Reproducible", "ContentionManager", "LoadBalancer", "PinThreads" },
      true);
    this->checkShown({ "Isovalue", "InsideLabel", "FeatureRatio", "LargestFeature" }, false);
    this->grab("panel-advanced.png");
    this->grabPanel("properties-advanced.png");
    this->set("InputMode", 1);
    this->set("Grading", 1);
    this->grabPanel("properties-isosurface.png");
    this->checkShown({ "InputMode", "Isovalue", "Inside", "InsideLabel", "IsosurfaceSmoothingSigma",
                       "LabelTable", "Grading", "FeatureRatio", "LargestFeature" },
      true);
    this->checkShown({ "SmoothingSigma" }, false);
    this->set("Optimise", 0);
    this->checkShown({ "OptimisationTimeLimit" }, false);
    this->set("Optimise", 1);
    this->set("InputMode", 0);
    this->set("Grading", 0);
    gear->click();
  }
}

/** Those that are shown are where the names are, from top to bottom. */
void pqVoxplexWindowTest::checkShown(const QStringList& names, bool shown)
{
  auto* const panel = this->Window->findChild<pqPropertiesPanel*>();
  int last = -1;
  for (const QString& name : names)
  {
    // In ParaView 5.13, the text beside Inside is a QLabel called InsideLabel.
    auto* const widget = panel ? panel->findChild<pqPropertyWidget*>(name) : nullptr;
    this->check(
      widget && widget->isVisible() == shown, name + (shown ? " is shown" : " is not shown"));
    if (widget && shown)
    {
      const int place = widget->mapTo(panel, QPoint(0, 0)).y();
      this->check(place > last, name + " is below what comes before it");
      last = place;
    }
  }
}

/** As if the user had chosen it, without Apply. */
void pqVoxplexWindowTest::set(const char* property, int value)
{
  vtkSMPropertyHelper(this->Mesher->getProxy(), property).Set(value);
  this->wait(300);
}

/** The whole list of properties, however much of it the window shows. */
void pqVoxplexWindowTest::grabPanel(const QString& name)
{
  auto* const panel = this->Window->findChild<pqPropertiesPanel*>();
  auto* const area = panel ? panel->findChild<QScrollArea*>() : nullptr;
  this->check(area != nullptr, "the list of properties");
  if (area)
  {
    this->wait(300);
    const QString path = qEnvironmentVariable("VOXPLEX_TEST_OUTPUT") + "/" + name;
    this->check(area->widget()->grab().save(path), "save " + path);
  }
}

void pqVoxplexWindowTest::testDependentProperties()
{
  auto* const panel = this->Window->findChild<pqPropertiesPanel*>();
  auto* const delta = panel ? panel->findChild<QWidget*>("Delta") : nullptr;
  this->check(delta && delta->isEnabled(), "Delta can be changed");
  this->set("NumberOfElements", 70000);
  this->check(delta && !delta->isEnabled(), "Delta is greyed out beside a number of elements");
  this->apply();
  const double elements =
    static_cast<double>(this->Mesher->getOutputPort(0)->getDataInformation()->GetNumberOfCells());
  this->check(std::abs(elements / 70000.0 - 1.0) <= 0.1, "the number of elements");
  this->set("NumberOfElements", 0);
  this->check(delta && delta->isEnabled(), "Delta can be changed again");
  this->apply();
  this->set("InputMode", 1);
  this->checkShown({ "InputMode", "Isovalue", "Inside", "LabelTable" }, true);
  this->checkShown({ "InsideLabel", "SmoothingSigma" }, false);
  this->set("InputMode", 0);
}

void pqVoxplexWindowTest::testColors()
{
  if (this->Mesher == nullptr)
  {
    return;
  }
  auto* const representation = vtkSMPVRepresentationProxy::SafeDownCast(
    this->Mesher->getOutputPort(0)->getRepresentation(pqActiveObjects::instance().activeView())
      ? this->Mesher->getOutputPort(0)
          ->getRepresentation(pqActiveObjects::instance().activeView())
          ->getProxy()
      : nullptr);
  this->check(representation != nullptr, "the mesh is shown after Apply");
  this->check(representation &&
      QString(vtkSMPropertyHelper(representation, "Representation").GetAsString()) ==
        "Surface With Edges",
    "with its edges");
  this->check(representation && representation->GetUsingScalarColoring(), "coloured by its labels");
  // Categories by themselves, with the names in the table beside the atlas.
  vtkSMProxy* const map = this->colorMap();
  this->check(vtkSMPropertyHelper(map, "IndexedLookup").GetAsInt() == 1, "as categories");
  this->check(
    vtkSMPropertyHelper(map, "Annotations").GetNumberOfElements() == 2 * 116, "116 of them");
  this->check(QString(vtkSMPropertyHelper(map, "Annotations").GetAsString(1)) == "Precentral_L",
    "with names");

  // What the user changes stays, unless the labels are others.
  vtkSMPropertyHelper(map, "IndexedLookup").Set(0);
  map->UpdateVTKObjects();
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(4.5);
  this->apply();
  this->check(
    vtkSMPropertyHelper(map, "IndexedLookup").GetAsInt() == 0, "the user's colour map stays");
  vtkSMPropertyHelper(map, "IndexedLookup").Set(1);
  map->UpdateVTKObjects();

  // A source with names: a file.
  const QString path = qEnvironmentVariable("VOXPLEX_TEST_OUTPUT") + "/named.vti";
  writeNamedImage(path);
  auto* const builder = pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* const named = builder->createReader(
    "sources", "XMLImageDataReader", QStringList(path), pqActiveObjects::instance().activeServer());
  this->apply();
  this->check(QString(vtkSMPropertyHelper(map, "Annotations").GetAsString(1)) == "liver",
    "names of a file's field data");

  // Beside another mesh, which is shown, the camera stays.
  vtkSMProxy* const view = pqActiveObjects::instance().activeView()->getProxy();
  vtkSMPropertyHelper camera(view, "CameraPosition");
  const double near[] = { 10.0, 20.0, 300.0 };
  camera.Set(near, 3);
  view->UpdateVTKObjects();
  pqPipelineSource* const second = builder->createFilter("filters", "VoxplexTetMesh", named);
  this->apply();
  this->check(second->getOutputPort(0)->getDataInformation()->GetNumberOfCells() > 0 &&
      camera.GetDoubleArray() == std::vector<double>(near, near + 3),
    "the camera stays for a second mesh");
  pqActiveObjects::instance().activeView()->resetDisplay();
  builder->destroy(second);
  builder->destroy(named);
  pqActiveObjects::instance().setActiveSource(this->Mesher);
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(4.0);
  this->apply();
}

vtkSMProxy* pqVoxplexWindowTest::colorMap() const
{
  vtkNew<vtkSMTransferFunctionManager> maps;
  return maps->GetColorTransferFunction("Label", this->Mesher->proxyManager());
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexWindowTest::takePicture()
{
  auto* const view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (this->Mesher == nullptr || view == nullptr)
  {
    return;
  }
  // Cut open, whole elements, seen from the side of the cut; 116 names do not fit into a legend.
  pqPipelineSource* const clip = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "Clip", this->Mesher);
  vtkSMProxy* const plane = vtkSMPropertyHelper(clip->getProxy(), "ClipFunction").GetAsProxy();
  const double origin[] = { 22.0, 0.0, 0.0 };
  vtkSMPropertyHelper(plane, "Origin").Set(origin, 3);
  plane->UpdateVTKObjects();
  vtkSMPropertyHelper(clip->getProxy(), "PreserveInputCells").Set(1);
  this->apply();
  vtkSMPropertyHelper(clip->getProxy(), "ClipFunction").GetAsProxy()->UpdateVTKObjects();
  pqActiveObjects::instance().setActiveSource(this->Mesher);
  auto* const clipped = vtkSMPVRepresentationProxy::SafeDownCast(
    clip->getOutputPort(0)->getRepresentation(view)->getProxy());
  clipped->HideScalarBarIfNotNeeded(view->getProxy());
  clipped->SetScalarBarVisibility(view->getProxy(), false);
  vtkSMPropertyHelper(clipped, "Representation").Set("Surface With Edges");
  const double edges[] = { 0.2, 0.2, 0.2 };
  vtkSMPropertyHelper(clipped, "EdgeColor").Set(edges, 3);
  clipped->UpdateVTKObjects();
  const double look[] = { -1.0, 0.35, -0.3 };
  const double up[] = { 0.0, 0.0, 1.0 };
  view->resetViewDirection(look[0], look[1], look[2], up[0], up[1], up[2]);
  view->forceRender();
  auto* const messages = this->Window->findChild<QDockWidget*>("outputWidgetDock");
  this->check(messages && messages->isVisible(), "warnings are in the Output Messages");
  if (messages)
  {
    messages->close();
  }
  this->grab("window.png");
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexWindowTest::onStart()
{
  ++this->Executions;
}

void pqVoxplexWindowTest::onEnd()
{
  --this->Executions;
}

/** What is due while the filter executes waits for its end. */
void pqVoxplexWindowTest::testWaiting()
{
  pqView* const view = pqActiveObjects::instance().activeView();
  if (this->Mesher == nullptr || view == nullptr)
  {
    return;
  }
  vtkSmartPointer<vtkSMSourceProxy> surface;
  surface.TakeReference(vtkSMSourceProxy::SafeDownCast(
    this->Mesher->proxyManager()->NewProxy("filters", "DataSetSurfaceFilter")));
  vtkSMPropertyHelper(surface, "Input").Set(this->Mesher->getProxy());
  surface->UpdateVTKObjects();

  int dialogs = 0, updates = 0;
  QStringList inside;
  const auto note = [&](const char* what)
  {
    if (this->Executions > 0)
    {
      inside << what;
    }
  };
  QTimer dialogTimer, updateTimer;
  this->connect(&dialogTimer, &QTimer::timeout, this,
    [&]
    {
      note("a dialog");
      ++dialogs;
      QDialog dialog(this->Window);
      QTimer::singleShot(0, &dialog, SLOT(reject()));
      dialog.exec();
    });
  this->connect(&updateTimer, &QTimer::timeout, this,
    [&]
    {
      note("an update");
      ++updates;
      surface->UpdatePipeline();
    });
  QObject during;
  bool started = false;
  this->connect(view, &pqView::beginRender, &during, [&] { note("a picture"); });
  this->connect(pqApplicationCore::instance()->getProgressManager(), &pqProgressManager::progress,
    &during,
    [&]
    {
      if (this->Executions > 0 && !started)
      {
        started = true;
        for (QTimer* timer : { &dialogTimer, &updateTimer })
        {
          timer->setSingleShot(true);
          timer->start(1);
        }
        this->Window->resize(this->Window->size() + QSize(20, 20));
      }
    });
  vtkObject* const algorithm =
    vtkObject::SafeDownCast(this->Mesher->getProxy()->GetClientSideObject());
  const unsigned long tags[] = { algorithm->AddObserver(
                                   vtkCommand::StartEvent, this, &pqVoxplexWindowTest::onStart),
    algorithm->AddObserver(vtkCommand::EndEvent, this, &pqVoxplexWindowTest::onEnd) };
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(2.0);
  this->apply();
  for (const unsigned long tag : tags)
  {
    algorithm->RemoveObserver(tag);
  }
  this->check(started, "progress while the filter executes");
  this->check(inside.isEmpty(), "inside the filter: " + inside.join(", "));
  this->check(dialogs == 1 && updates == 1, "the timers when it has ended");
  this->check(surface->GetDataInformation()->GetNumberOfCells() > 1000, "what a timer updates");
  this->check(
    this->Mesher->getOutputPort(0)->getDataInformation()->GetNumberOfCells() > 100000, "the mesh");
  this->Window->resize(this->Window->size() - QSize(20, 20));
  this->wait(300);
}

/** Only calls that are queued do not wait: if one opens a dialog, that can be closed. */
void pqVoxplexWindowTest::testQueued()
{
  if (this->Mesher == nullptr)
  {
    return;
  }
  QObject during;
  bool started = false;
  this->connect(pqApplicationCore::instance()->getProgressManager(), &pqProgressManager::progress,
    &during,
    [&]
    {
      if (!started)
      {
        started = true;
        QMetaObject::invokeMethod(
          this, &pqVoxplexWindowTest::clickDialogAway, Qt::QueuedConnection);
      }
    });
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(2.1);
  this->apply();
}

void pqVoxplexWindowTest::clickDialogAway()
{
  QDialog dialog(this->Window);
  QPushButton button("Close", &dialog);
  this->connect(&button, &QPushButton::clicked, &dialog, &QDialog::accept);
  QTimer clicks;
  this->connect(&clicks, &QTimer::timeout, &dialog, [&] { click(&button); });
  clicks.start(500);
  QTimer::singleShot(60000, &dialog, SLOT(reject())); // only where the clicks do not arrive
  this->check(dialog.exec() == QDialog::Accepted, "a dialog inside the filter can be closed");
}

void pqVoxplexWindowTest::testAbort()
{
  if (this->Mesher == nullptr)
  {
    return;
  }
  auto* const button = this->Window->findChild<QToolButton*>("AbortButton");
  QApplication::setDoubleClickInterval(0); // each click is one
  bool pressed = false;
  QObject during;
  if (button)
  {
    this->connect(button, &QToolButton::pressed, &during, [&] { pressed = true; });
  }
  this->connect(pqApplicationCore::instance()->getProgressManager(), &pqProgressManager::progress,
    &during,
    [&]
    {
      if (!pressed && button && button->isVisible() && button->isEnabled())
      {
        this->Window->raise(); // above ParaView's messages
        click(button);
      }
    });
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta")
    .Set(0.7); // minutes, if it were not stopped
  vtkSMPropertyHelper(this->Mesher->getProxy(), "NumberOfThreads").Set(1);
  Messages.clear();
  const QtMessageHandler handler = qInstallMessageHandler(
    [](QtMsgType, const QMessageLogContext&, const QString& text) { Messages << text; });
  this->apply();
  qInstallMessageHandler(handler);
  this->check(
    Messages.filter("Meshing was aborted").size() == 1, "the messages say why nothing is there");
  this->check(pressed, "the Abort button can be pressed while the filter executes");
  this->check(this->Mesher->getOutputPort(0)->getDataInformation()->GetNumberOfCells() == 0,
    "nothing comes out of a filter that was stopped");
  vtkSMPropertyHelper(this->Mesher->getProxy(), "Delta").Set(5.0);
  this->apply();
  this->check(this->Mesher->getOutputPort(0)->getDataInformation()->GetNumberOfCells() > 5000,
    "the next Apply meshes");
}
